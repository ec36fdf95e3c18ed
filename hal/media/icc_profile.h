#pragma once

#include <memory>
#include <optional>

#include "hal/media/handles.h"

namespace pleinair::hal::libav {

/// The way from a frame's ICC profile (ICC.1:2010) to sRGB, by lcms2, with the perceptual intent,
/// as image viewers show it. Any thread; one thread at a time.
class IccConversion {
 public:
  /// Nothing where the frame has no profile, or one that says nothing for this program: it is
  /// sRGB's own to within a level of 255, it is unreadable, it is for other channels than the frame
  /// has (CMYK), or the frame is HDR, whose curve decides.
  static std::optional<IccConversion> of(const AVFrame& frame);

  /// The layout that apply() reads: that of the frame without Y'CbCr and palettes, of 8 or 16 bits.
  AVPixelFormat sourceLayout() const { return source_; }
  /// The layout that it writes: RGB, with the alpha and the depth of the source.
  AVPixelFormat targetLayout() const { return target_; }
  /// Both frames are of one size, and in these layouts.
  void apply(const AVFrame& source, AVFrame& target) const;

 private:
  IccConversion() = default;

  struct FreeTransform {
    void operator()(void* transform) const;
  };
  std::unique_ptr<void, FreeTransform> transform_;
  AVPixelFormat source_ = AV_PIX_FMT_NONE;
  AVPixelFormat target_ = AV_PIX_FMT_NONE;
};

}  // namespace pleinair::hal::libav
