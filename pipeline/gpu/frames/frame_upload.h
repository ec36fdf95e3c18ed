#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "hal/image.h"
#include "pipeline/gpu/images/aspect_fill.h"
#include "pipeline/gpu/images/resampler.h"
#include "pipeline/gpu/programs/program.h"
#include "pipeline/gpu/programs/shader_library.h"
#include "pipeline/gpu/render_target.h"
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
  /// The same of planes that are textures already, as importedPlane() has them: nothing is copied.
  const Texture& show(const hal::FrameFormat& format, std::span<const Texture> planes,
                      hal::FrameSize size, const AspectFill& fit);

  /// The last frame at its own size, RGBA8. Precondition: there was one.
  const Texture& native() const { return native_; }
  /// Bytes of planes that were copied so far.
  std::uint64_t uploadedBytes() const { return uploadedBytes_; }

 private:
  void uploadPlanes(const hal::ImageView& image);
  void prepareNative(hal::FrameSize size);
  void convert(const hal::FrameFormat& format, std::span<const Texture> planes, bool areImported);

  std::array<Program, 6> convert_;  // one a layout
  Program convertBytes_;            // RGB of single bytes
  hal::FrameFormat planesFormat_;
  std::array<Texture, 3> planes_;
  std::uint64_t uploadedBytes_ = 0;
  Texture native_;  // at the frame's own size
  RenderTarget nativeTarget_;
  Resampler resampler_;
};

}  // namespace pleinair::gpu
