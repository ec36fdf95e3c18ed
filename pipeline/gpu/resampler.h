#pragma once

#include "hal/pixel_format.h"
#include "pipeline/gpu/program.h"
#include "pipeline/gpu/render_target.h"
#include "pipeline/gpu/shader_library.h"
#include "pipeline/gpu/texture.h"

namespace pleinair::gpu {

/// Brings a picture to another size: filled, centred, the overhang cut off (CoverFit).
class Resampler {
 public:
  explicit Resampler(const ShaderLibrary& library);

  /// `picture` itself if it has the size already, else a scaled one, valid until the next call.
  /// Precondition: RGBA8 with the LINEAR filter.
  const Texture& resample(const Texture& picture, hal::FrameSize size);

 private:
  Program program_;
  Texture scaled_;
  RenderTarget target_;
};

}  // namespace pleinair::gpu
