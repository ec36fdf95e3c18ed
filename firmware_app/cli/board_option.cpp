#include "firmware_app/cli/board_option.h"

#include <charconv>
#include <string_view>
#include <system_error>

#include <fmt/format.h>

#include "hal/error.h"

namespace pleinair::app {
namespace {

constexpr const char* kKinds =
    "checkerboard:COLUMNSxROWS (inner corners, 3 to 50 a side) or "
    "aprilgrid:COLUMNSxROWS (tags, 2 to 20 a side)";
constexpr double kLongestMetres = 10.0;
constexpr int kTagIds = 587;  // ids in tag36h11

[[noreturn]] void refuse(std::string subject, std::string problem, std::string remedy) {
  throw hal::Failure(hal::Error{.kind = hal::ErrorKind::kInvalidArgument,
                                .subject = std::move(subject),
                                .problem = std::move(problem),
                                .remedy = std::move(remedy)});
}

[[noreturn]] void refuseKind(const std::string& found) {
  refuse("--board", fmt::format("found \"{}\"", found), fmt::format("allowed: {}", kKinds));
}

struct Sides {
  int columns = 0;
  int rows = 0;
};

/// Parses "9x6"; both numbers from `least` to `most`.
std::optional<Sides> sidesOf(std::string_view text, int least, int most) {
  const std::size_t by = text.find('x');
  if (by == std::string_view::npos) return std::nullopt;
  Sides sides;
  const auto read = [&](std::string_view digits, int& side) {
    const auto [end, status] = std::from_chars(digits.data(), digits.data() + digits.size(), side);
    return status == std::errc() && end == digits.data() + digits.size() && side >= least &&
           side <= most;
  };
  if (!read(text.substr(0, by), sides.columns) || !read(text.substr(by + 1), sides.rows)) {
    return std::nullopt;
  }
  return sides;
}

double lengthOf(const std::optional<double>& metres, const char* option, const char* what) {
  if (!metres) {
    refuse(option, "is missing", fmt::format("give {} in metres, as measured on the print", what));
  }
  if (!(*metres > 0.0 && *metres <= kLongestMetres)) {
    refuse(option, fmt::format("found {:g}", *metres),
           fmt::format("allowed: metres in (0, {:g}]", kLongestMetres));
  }
  return *metres;
}

template <class Value>
void refuseForeign(const std::optional<Value>& value, const char* option, const char* kind) {
  if (value) refuse(option, fmt::format("is of no {}", kind), "leave it out");
}

calibration::Board checkerboardOf(const BoardOption& option, std::string_view text) {
  const std::optional<Sides> sides = sidesOf(text, 3, 50);
  if (!sides) refuseKind(option.kind);
  refuseForeign(option.tagEdge, "--tag-edge", "checkerboard");
  refuseForeign(option.spacing, "--spacing", "checkerboard");
  refuseForeign(option.firstId, "--first-id", "checkerboard");
  return calibration::Board(calibration::Checkerboard{
      .columns = sides->columns,
      .rows = sides->rows,
      .squareMetres = lengthOf(option.square, "--square", "the side of a square")});
}

calibration::Board aprilGridOf(const BoardOption& option, std::string_view text) {
  const std::optional<Sides> sides = sidesOf(text, 2, 20);
  if (!sides) refuseKind(option.kind);
  refuseForeign(option.square, "--square", "aprilgrid");
  const double spacing = option.spacing.value_or(0.3);
  if (!(spacing >= 0.1 && spacing <= 2.0)) {
    refuse("--spacing", fmt::format("found {:g}", spacing),
           "allowed: the gap between tags as a share of a tag's edge, in [0.1, 2]");
  }
  const int firstId = option.firstId.value_or(0);
  const int tags = sides->columns * sides->rows;
  if (firstId < 0 || firstId + tags > kTagIds) {
    refuse("--first-id", fmt::format("found {}", firstId),
           fmt::format("allowed: 0 to {} for {} tags of tag36h11", kTagIds - tags, tags));
  }
  return calibration::Board(calibration::AprilGrid{
      .columns = sides->columns,
      .rows = sides->rows,
      .tagEdgeMetres = lengthOf(option.tagEdge, "--tag-edge", "the edge of a tag's black square"),
      .spacing = spacing,
      .firstId = firstId});
}

}  // namespace

calibration::Board boardOf(const BoardOption& option) {
  const std::size_t colon = option.kind.find(':');
  if (colon == std::string::npos) refuseKind(option.kind);
  const std::string_view name = std::string_view(option.kind).substr(0, colon);
  const std::string_view sides = std::string_view(option.kind).substr(colon + 1);
  if (name == "checkerboard") return checkerboardOf(option, sides);
  if (name == "aprilgrid") return aprilGridOf(option, sides);
  refuseKind(option.kind);
}

}  // namespace pleinair::app
