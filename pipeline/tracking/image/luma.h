#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

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
