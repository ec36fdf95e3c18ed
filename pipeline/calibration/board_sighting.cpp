#include "pipeline/calibration/board_sighting.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <vector>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <opencv2/imgproc.hpp>

#include "hal/median.h"

namespace pleinair::calibration {
namespace {

/// Bilinearly interpolated grey level; pixel centres at +0.5. Precondition: `px` is at least 1 px
/// inside of the image.
double greyAt(const hal::PlaneView& luma, const glm::dvec2& px) {
  const glm::dvec2 place = px - 0.5;
  const glm::dvec2 whole = glm::floor(place);
  const glm::dvec2 part = place - whole;
  const std::size_t at =
      static_cast<std::size_t>(whole.y) * luma.strideBytes + static_cast<std::size_t>(whole.x);
  const std::size_t below = at + luma.strideBytes;
  const auto& grey = luma.bytes;
  return glm::mix(glm::mix<double>(grey[at], grey[at + 1], part.x),
                  glm::mix<double>(grey[below], grey[below + 1], part.x), part.y);
}

/// Whether two black and two white areas meet at a position, as at the corners of all boards:
/// opposite points of a circle around it are alike then. cornerSubPix leaves a corner that it lost
/// where it started.
bool isCrossing(const hal::PlaneView& luma, const glm::dvec2& px, double radius) {
  constexpr int kDirections = 16;
  constexpr double kMinContrast = 12.0;  // grey levels
  constexpr double kMaxAsymmetry = 0.3;  // difference of opposite points, relative to the contrast
  std::array<double, kDirections> grey{};
  for (int i = 0; i < kDirections; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / kDirections;
    grey.at(static_cast<std::size_t>(i)) =
        greyAt(luma, px + radius * glm::dvec2(std::cos(angle), std::sin(angle)));
  }
  const auto [min, max] = std::ranges::minmax(grey);
  double unlike = 0.0;
  for (std::size_t i = 0; i < kDirections / 2; ++i) {
    unlike += std::abs(grey.at(i) - grey.at(i + kDirections / 2)) / (kDirections / 2.0);
  }
  return max - min >= kMinContrast && unlike <= kMaxAsymmetry * (max - min);
}

}  // namespace

void refineCorners(const hal::PlaneView& luma, hal::FrameSize size, int windowHalf,
                   double softeningPx, std::vector<SightedCorner>& corners) {
  const double margin = windowHalf + 6.0;  // of the neighbourhood that is read
  std::erase_if(corners, [&](const SightedCorner& corner) {
    return corner.px.x < margin || corner.px.y < margin || corner.px.x > size.width - margin ||
           corner.px.y > size.height - margin;
  });
  if (corners.empty()) return;
  const cv::Mat whole(size.height, size.width, CV_8UC1,
                      const_cast<std::uint8_t*>(luma.bytes.data()), luma.strideBytes);
  cv::Mat softened;  // a copy: the image's own pixels are borrowed
  if (softeningPx > 0.0) cv::GaussianBlur(whole, softened, {}, softeningPx);
  const cv::Mat& picture = softeningPx > 0.0 ? softened : whole;
  std::vector<cv::Point2f> points;  // OpenCV counts pixel centres from 0
  points.reserve(corners.size());
  for (const SightedCorner& corner : corners) {
    points.emplace_back(static_cast<float>(corner.px.x - 0.5),
                        static_cast<float>(corner.px.y - 0.5));
  }
  constexpr int kSteps = 50;
  constexpr double kStillPx = 0.003;
  cv::cornerSubPix(picture, points, {windowHalf, windowHalf}, {-1, -1},
                   {cv::TermCriteria::COUNT | cv::TermCriteria::EPS, kSteps, kStillPx});
  const double radius = std::clamp(0.6 * windowHalf, 1.5, 4.0);
  std::vector<SightedCorner> refined;
  refined.reserve(corners.size());
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const glm::dvec2 px(points[i].x + 0.5, points[i].y + 0.5);
    const glm::dvec2 moved = px - corners[i].px;
    if (std::hypot(moved.x, moved.y) > windowHalf || !isCrossing(luma, px, radius)) continue;
    refined.push_back({corners[i].id, px});
  }
  corners = std::move(refined);
}

namespace {

constexpr double kMinContrast = 12.0;  // grey levels
constexpr double kMaxReachPx = 10.0;
constexpr double kMinReachPx = 3.0;  // a blur wider than the reach would look sharp
constexpr int kStepsPerPx = 4;

/// The width of one edge, from the mean profile across its middle fifth.
std::optional<double> widthOf(const hal::PlaneView& luma, hal::FrameSize size, const glm::dvec2& a,
                              const glm::dvec2& b, double clearance) {
  constexpr int kLines = 7;
  const glm::dvec2 along = b - a;
  const double length = glm::length(along);
  const double reach = std::min(clearance * length, kMaxReachPx);
  if (reach < kMinReachPx) return std::nullopt;
  const glm::dvec2 across(-along.y / length, along.x / length);
  const glm::dvec2 middle = (a + b) / 2.0;
  const double room = reach + 0.1 * length + 2.0;
  if (middle.x < room || middle.y < room || middle.x > size.width - room ||
      middle.y > size.height - room) {
    return std::nullopt;
  }
  const int steps = static_cast<int>(2.0 * reach * kStepsPerPx);
  std::vector<double> profile;
  for (int step = 0; step <= steps; ++step) {
    const glm::dvec2 at = middle + across * (static_cast<double>(step) / kStepsPerPx - reach);
    double sum = 0.0;
    for (int line = 0; line < kLines; ++line) {
      sum += greyAt(luma, at + along * (0.2 * (line / (kLines - 1.0) - 0.5)));
    }
    profile.push_back(sum / kLines);
  }
  const double contrast = std::abs(profile.back() - profile.front());
  if (contrast < kMinContrast) return std::nullopt;
  double steepest = 0.0;  // grey levels per pixel, over one pixel
  for (std::size_t i = kStepsPerPx; i < profile.size(); ++i) {
    steepest = std::max(steepest, std::abs(profile[i] - profile[i - kStepsPerPx]));
  }
  return contrast / steepest;
}

std::optional<double> medianWidth(std::vector<double>& values) {
  if (values.empty()) return std::nullopt;
  return hal::medianOf(values);
}

}  // namespace

std::optional<double> edgeWidth(const hal::PlaneView& luma, hal::FrameSize size, const Board& board,
                                std::span<const SightedCorner> corners) {
  std::vector<const SightedCorner*> byId(board.corners().size(), nullptr);
  for (const SightedCorner& corner : corners) byId[static_cast<std::size_t>(corner.id)] = &corner;
  std::array<std::vector<double>, 2> widths;
  for (const BoardEdge& edge : board.edges()) {
    const SightedCorner* from = byId[static_cast<std::size_t>(edge.from)];
    const SightedCorner* to = byId[static_cast<std::size_t>(edge.to)];
    if (from == nullptr || to == nullptr) continue;
    if (const auto width = widthOf(luma, size, from->px, to->px, edge.clearance)) {
      widths[edge.isAlongX ? 1 : 0].push_back(*width);
    }
  }
  const std::optional<double> one = medianWidth(widths[0]);
  const std::optional<double> other = medianWidth(widths[1]);
  if (!one || !other) return one ? one : other;
  return std::max(*one, *other);
}

}  // namespace pleinair::calibration
