#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "hal/image.h"

namespace pleinair::tracking {

/// Converts images of any format to BT.601 luma, for detectors. Bayer mosaics are interpolated
/// bilinearly, so that luma is not shifted against the image. One thread at a time.
class LumaConverter {
 public:
  /// Returns one byte per pixel at the image's size. The result is the image's own luma plane where
  /// it has one; otherwise it is a buffer of this object, valid until the next call. Precondition:
  /// image.isComplete().
  hal::PlaneView convert(const hal::ImageView& image);
  /// The same in a buffer of this object always: the image is read once, and not kept.
  hal::PlaneView copy(const hal::ImageView& image);

 private:
  std::vector<std::uint8_t> buffer_;
};

class LumaPyramid;

/// A frame's luma and luma pyramid, shared by all detectors. Both are made on first use and kept
/// for the frame; buffers are kept from frame to frame. One thread at a time.
class LumaFrame {
 public:
  /// Takes the next frame, of any format. Its pixels must stay valid while this object is used for
  /// the frame. Precondition: image.isComplete().
  void take(const hal::ImageView& image);
  /// Takes the next frame and copies its luma: its pixels may go at once, and are read once, where
  /// reading them is slow. Precondition: image.isComplete().
  void takeCopy(const hal::ImageView& image);
  /// Takes a frame that is luma already; its pixels must stay valid in the same way.
  void take(const hal::PlaneView& luma, hal::FrameSize size) { takeReduced(luma, size, size); }
  /// Takes a smaller image of a frame of `frameSize`, from which the pyramid is made: luma() is not
  /// there. Its pixels must stay valid until pyramid() was called, which reads them once.
  void takeReduced(const hal::PlaneView& luma, hal::FrameSize lumaSize, hal::FrameSize frameSize);

  // Precondition of all functions below: a frame was taken.
  hal::FrameSize size() const { return size_; }
  /// Precondition: the frame was not taken reduced.
  const hal::PlaneView& luma();
  /// A pyramid whose longer side is at most kLongSidePx. It is not changed while it is shared; key
  /// frames keep it.
  std::shared_ptr<const LumaPyramid> pyramid();
  static constexpr int kLongSidePx = 640;

 private:
  LumaConverter converter_;
  hal::FrameSize size_;
  hal::FrameSize lumaSize_;
  hal::ImageView image_;
  std::optional<hal::PlaneView> luma_;
  std::shared_ptr<const LumaPyramid> pyramid_;
  std::vector<std::shared_ptr<LumaPyramid>> pyramids_;  // reused when nobody shares them
};

}  // namespace pleinair::tracking
