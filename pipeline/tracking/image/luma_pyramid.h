#pragma once

#include <concepts>
#include <cstddef>
#include <vector>

#include <glm/vec2.hpp>
#include <opencv2/core.hpp>

#include "hal/image.h"

namespace pleinair::tracking {

/// A frame's luma, reduced to the size at which features are followed, then halved repeatedly, with
/// gradients as Lucas-Kanade reads them. Pixel centres of the pyramid are integers (as in OpenCV);
/// pixel centres of the frame are at +0.5.
class LumaPyramid {
 public:
  /// Copies a frame's luma, reduced so that the longer side is at most `longSidePx`.
  void load(const hal::PlaneView& luma, hal::FrameSize frameSize, int longSidePx) {
    load(luma, frameSize, frameSize, longSidePx);
  }
  /// The same of luma that was reduced before, and shows what the frame shows.
  void load(const hal::PlaneView& luma, hal::FrameSize lumaSize, hal::FrameSize frameSize,
            int longSidePx);

  hal::FrameSize frameSize() const { return frameSize_; }
  /// The reduced image, without the border that filters need.
  const cv::Mat& picture() const { return levels_.front(); }
  /// Two entries per level: the image, then its gradients (CV_16SC2, times 32).
  const std::vector<cv::Mat>& levels() const { return levels_; }
  /// The smallest of the levels' images that is large enough, or else the largest one.
  template <std::predicate<cv::Size> IsLargeEnough>
  const cv::Mat& smallest(const IsLargeEnough& isLargeEnough) const {
    std::size_t i = 0;
    while (i + 2 < levels_.size() && isLargeEnough(levels_[i + 2].size())) i += 2;
    return levels_[i];
  }
  /// Size of a pyramid px, in frame px.
  glm::dvec2 reduction() const { return reduction_; }

  glm::dvec2 framePx(const cv::Point2f& own) const {
    return reduction_ * (glm::dvec2(own.x, own.y) + 0.5);
  }
  cv::Point2f ownPx(const glm::dvec2& px) const {
    const glm::dvec2 p = px / reduction_ - 0.5;
    return {static_cast<float>(p.x), static_cast<float>(p.y)};
  }
  /// Whether a point lies inside, at least `border` pyramid px from the image's sides.
  bool isInside(const cv::Point2f& own, double border) const;

  /// Window and number of levels for following points.
  static constexpr int kWindowPx = 15;
  static constexpr int kLevels = 3;  // beside the first

 private:
  hal::FrameSize frameSize_;
  glm::dvec2 reduction_{1.0};
  cv::Mat reduced_;
  std::vector<cv::Mat> levels_;
};

}  // namespace pleinair::tracking
