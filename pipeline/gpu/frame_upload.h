#pragma once

#include <array>

#include "hal/image.h"
#include "pipeline/gpu/aspect_fill.h"
#include "pipeline/gpu/program.h"
#include "pipeline/gpu/render_target.h"
#include "pipeline/gpu/resampler.h"
#include "pipeline/gpu/shader_library.h"
#include "pipeline/gpu/texture.h"

namespace pleinair::gpu {

/// Brings camera frames of any layout to the GPU as sRGB-coded RGBA pictures: planes are copied, a
/// pass applies matrix and range (ITU-R BT.601, BT.709), demosaics Bayer, and scales.
/// Chroma is sited as MPEG-2 has it for limited range (left) and as JPEG has it for full range
/// (centre).
class FrameUploader {
 public:
  explicit FrameUploader(const ShaderLibrary& library);

  /// The frame, filling `size` (AspectFill). Valid until the next upload. Allocates only for a new
  /// size or layout of frames, and for each `size` once. Precondition: image.isComplete().
  const Texture& upload(const hal::ImageView& image, hal::FrameSize size) {
    return upload(image, size, aspectFill(image.format.size, size));
  }
  /// The same with another fit.
  const Texture& upload(const hal::ImageView& image, hal::FrameSize size, const AspectFill& fit);

 private:
  void uploadPlanes(const hal::ImageView& image);
  void convert(const hal::FrameFormat& format);

  std::array<Program, 6> convert_;  // one a layout
  hal::FrameFormat planesFormat_;
  std::array<Texture, 3> planes_;
  Texture native_;  // at the frame's own size
  RenderTarget nativeTarget_;
  Resampler resampler_;
};

}  // namespace pleinair::gpu
