#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include <glm/vec2.hpp>
#include <opencv2/core.hpp>

#include "hal/image.h"

namespace pleinair::tracking {

/// Makes the BT.601 luma of pictures of any format, for detectors. Bayer mosaics are interpolated
/// bilinearly, so that luma is not shifted against the picture. One thread at a time.
class LumaConverter {
 public:
  /// One byte a pixel, the picture's size: the picture's own plane where it has one, else a buffer
  /// of this object, valid until the next call. Precondition: image.isComplete().
  hal::PlaneView convert(const hal::ImageView& image);

 private:
  std::vector<std::uint8_t> buffer_;
};

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

class LumaPyramid;

/// A frame's luma for all that is found out in it: it and its pyramid are made when they are first
/// asked for, and then kept. Keeps its buffers from frame to frame. One thread at a time.
class LumaFrame {
 public:
  /// The next frame, of any format, whose pixels stay as long as this is asked about it.
  /// Precondition: image.isComplete().
  void take(const hal::ImageView& image);
  /// Likewise, of which there is luma already.
  void take(const hal::PlaneView& luma, hal::FrameSize size);

  // Precondition of all: a frame was taken.
  hal::FrameSize size() const { return size_; }
  const hal::PlaneView& luma();
  /// Of a picture of at most kLongSidePx. Not changed as long as it is shared: key frames keep it.
  std::shared_ptr<const LumaPyramid> pyramid();
  static constexpr int kLongSidePx = 640;

 private:
  LumaConverter converter_;
  hal::FrameSize size_;
  hal::ImageView image_;
  std::optional<hal::PlaneView> luma_;
  std::shared_ptr<const LumaPyramid> pyramid_;
  std::vector<std::shared_ptr<LumaPyramid>> pyramids_;  // used again when nobody shares them
};

}  // namespace pleinair::tracking
