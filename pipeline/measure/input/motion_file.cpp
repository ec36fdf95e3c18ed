#include "pipeline/measure/input/motion_file.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <cstddef>
#include <fstream>
#include <iterator>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "config/config_error.h"
#include "config/suggestion.h"
#include "pipeline/measure/input/true_motion.h"

namespace pleinair::measure {
namespace {

using Json = nlohmann::json;

constexpr std::size_t kMaxBytes = 64'000'000;
/// With faster motion, no mark is visible twice.
constexpr double kMaxPixels = 1000;

constexpr const char* kAllowed =
    R"(give {"v": [vx, vy]} in px a frame, or {"homographies": [[9 numbers], …]})";

hal::Error wrong(const std::string& subject, std::string problem) {
  return {.kind = hal::ErrorKind::kInvalidInput,
          .subject = subject,
          .problem = std::move(problem),
          .remedy = kAllowed};
}

/// A list of exactly `Count` finite numbers.
template <std::size_t Count>
std::optional<std::array<double, Count>> numbersOf(const Json& list) {
  if (!list.is_array() || list.size() != Count) return std::nullopt;
  std::array<double, Count> numbers{};
  for (std::size_t i = 0; i < Count; ++i) {
    if (!list[i].is_number()) return std::nullopt;
    numbers.at(i) = list[i].get<double>();
    if (!std::isfinite(numbers.at(i))) return std::nullopt;
  }
  return numbers;
}

hal::Result<std::vector<cv::Matx33d>> homographiesOf(const Json& list, const std::string& subject) {
  if (!list.is_array() || list.empty()) {
    return tl::unexpected(wrong(subject, "\"homographies\" is no list of any"));
  }
  std::vector<cv::Matx33d> homographies;
  for (const Json& each : list) {
    const auto numbers = numbersOf<9>(each);
    const cv::Matx33d matrix = numbers ? cv::Matx33d(numbers->data()) : cv::Matx33d::zeros();
    if (std::abs(cv::determinant(matrix)) < 1e-9) {
      return tl::unexpected(
          wrong(subject, fmt::format("homography {} is not 9 numbers of an invertible matrix",
                                     homographies.size())));
    }
    homographies.push_back(matrix);
  }
  return homographies;
}

}  // namespace

hal::Result<MotionFile> parseMotion(std::string_view text, const std::string& subject) {
  const Json json = Json::parse(text, nullptr, false);
  if (json.is_discarded() || !json.is_object()) {
    return tl::unexpected(wrong(subject, "is not a JSON object"));
  }
  static const std::vector<std::string> kKeys{"v", "homographies"};
  for (const auto& [key, value] : json.items()) {
    if (std::ranges::find(kKeys, key) != kKeys.end()) continue;
    return tl::unexpected(
        wrong(subject, config::quoted(key) + ": " + config::unknownText("key", key, kKeys)));
  }
  MotionFile file;
  if (json.contains("v") == json.contains("homographies")) {
    return tl::unexpected(wrong(subject, R"(has to have one of "v" and "homographies")"));
  }
  if (json.contains("v")) {
    const auto numbers = numbersOf<2>(json["v"]);
    if (!numbers || std::hypot((*numbers)[0], (*numbers)[1]) > kMaxPixels) {
      return tl::unexpected(
          wrong(subject, fmt::format("\"v\" is not two numbers of up to {} px", kMaxPixels)));
    }
    file.perFrame = cv::Point2d((*numbers)[0], (*numbers)[1]);
    return file;
  }
  hal::Result<std::vector<cv::Matx33d>> homographies =
      homographiesOf(json["homographies"], subject);
  if (!homographies) return tl::unexpected(homographies.error());
  file.nextFromFrame = std::move(*homographies);
  return file;
}

hal::Result<MotionFile> readMotion(const std::filesystem::path& path) {
  std::ifstream stream(path, std::ios::binary);
  if (!stream) {
    return tl::unexpected(hal::errnoError(path.string(), "cannot open", errno, kAllowed));
  }
  std::string text;
  std::array<char, 65536> block{};
  while (stream.read(block.data(), block.size()) || stream.gcount() > 0) {
    text.append(block.data(), static_cast<std::size_t>(stream.gcount()));
    if (text.size() > kMaxBytes) return tl::unexpected(wrong(path.string(), "is too large"));
  }
  return parseMotion(text, path.string());
}

hal::Result<std::unique_ptr<TrueMotion>> motionOf(const MotionFile& file, cv::Size frame,
                                                  std::uint64_t frames,
                                                  const std::string& subject) {
  if (file.perFrame) return constantMotion(frame, *file.perFrame);
  if (file.nextFromFrame.size() + 1 < frames) {
    return tl::unexpected(
        wrong(subject, fmt::format("has {} homographies for {} frames, which need {}",
                                   file.nextFromFrame.size(), frames, frames - 1)));
  }
  std::vector<cv::Matx33d> fromFirst{cv::Matx33d::eye()};
  for (const cv::Matx33d& next : file.nextFromFrame) fromFirst.push_back(next * fromFirst.back());
  return homographyMotion(
      frame, fmt::format("{} homographies", file.nextFromFrame.size()),
      [fromFirst = std::move(fromFirst)](std::uint64_t index) { return fromFirst.at(index); });
}

}  // namespace pleinair::measure
