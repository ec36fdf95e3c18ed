#include "pipeline/calibration/corner_refinement.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include <opencv2/imgproc.hpp>

namespace pleinair::calibration {

void refineCorners(const hal::PlaneView& luma, hal::FrameSize size, int windowHalf,
                   std::vector<SightedCorner>& corners) {
  const double margin = windowHalf + 2.0;  // cornerSubPix looks one pixel further than its window
  std::erase_if(corners, [&](const SightedCorner& corner) {
    return corner.px.x < margin || corner.px.y < margin || corner.px.x > size.width - margin ||
           corner.px.y > size.height - margin;
  });
  if (corners.empty()) return;
  const cv::Mat picture(size.height, size.width, CV_8UC1,
                        const_cast<std::uint8_t*>(luma.bytes.data()), luma.strideBytes);
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
  std::vector<SightedCorner> refined;
  refined.reserve(corners.size());
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const glm::dvec2 px(points[i].x + 0.5, points[i].y + 0.5);
    // cornerSubPix puts a corner that leaves its window back to where it came from.
    const glm::dvec2 moved = px - corners[i].px;
    const bool isPutBack = moved == glm::dvec2(0.0);
    if (isPutBack || std::hypot(moved.x, moved.y) > windowHalf) continue;
    refined.push_back({corners[i].id, px});
  }
  corners = std::move(refined);
}

}  // namespace pleinair::calibration
