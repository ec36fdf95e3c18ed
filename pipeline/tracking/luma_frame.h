#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "hal/image.h"
#include "pipeline/tracking/luma.h"

namespace pleinair::tracking {

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
