#pragma once

#include <vector>

#include <glm/vec2.hpp>
#include <opencv2/core.hpp>

#include "hal/image.h"

namespace pleinair::tracking {

/// A frame's luma, reduced to a size at which things are followed and halved again and again, with
/// gradients, as Lucas-Kanade reads it. Its own px have integer centres (OpenCV's), the frame's
/// have theirs at +0.5.
class LumaPyramid {
 public:
  /// Takes a copy; the longer side is at most `longSidePx` then.
  void load(const hal::PlaneView& luma, hal::FrameSize frameSize, int longSidePx);

  hal::FrameSize frameSize() const { return frameSize_; }
  /// The reduced picture, without what is around it for filters.
  const cv::Mat& picture() const { return levels_.front(); }
  /// Twice as many as levels: each picture's gradients (32 times, CV_16SC2) follow it.
  const std::vector<cv::Mat>& levels() const { return levels_; }
  /// Frame px in a px of its own.
  glm::dvec2 reduction() const { return reduction_; }

  glm::dvec2 framePx(const cv::Point2f& own) const {
    return reduction_ * (glm::dvec2(own.x, own.y) + 0.5);
  }
  cv::Point2f ownPx(const glm::dvec2& px) const {
    const glm::dvec2 p = px / reduction_ - 0.5;
    return {static_cast<float>(p.x), static_cast<float>(p.y)};
  }
  /// Whether a point is inside, and `border` of its own px from the picture's sides.
  bool isInside(const cv::Point2f& own, double border) const;

  /// The windows and the levels that points are followed by.
  static constexpr int kWindowPx = 15;
  static constexpr int kLevels = 3;  // beside the first

 private:
  hal::FrameSize frameSize_;
  glm::dvec2 reduction_{1.0};
  cv::Mat reduced_;
  std::vector<cv::Mat> levels_;
};

}  // namespace pleinair::tracking
