#include "pipeline/calibration/corner_refinement.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>

#include <opencv2/imgproc.hpp>

#include "pipeline/calibration/grey_at.h"

namespace pleinair::calibration {
namespace {

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

}  // namespace pleinair::calibration
