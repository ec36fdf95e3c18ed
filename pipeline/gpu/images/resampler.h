#pragma once

#include "hal/pixel_format.h"
#include "pipeline/gpu/images/aspect_fill.h"
#include "pipeline/gpu/images/per_size.h"
#include "pipeline/gpu/programs/program.h"
#include "pipeline/gpu/programs/shader_library.h"
#include "pipeline/gpu/render_target.h"
#include "pipeline/gpu/texture.h"

namespace pleinair::gpu {

/// Brings a picture to other sizes. Keeps a texture for each size it was asked for.
class Resampler {
 public:
  explicit Resampler(const ShaderLibrary& library);

  /// `picture`, filling `size`: centred, the overhang cut off. Itself if it has the size already,
  /// else a scaled one, valid until the next call with this size. Precondition: RGBA8 with the
  /// LINEAR filter.
  const Texture& resample(const Texture& picture, hal::FrameSize size) {
    return resample(picture, size, aspectFill(picture.size(), size));
  }
  /// The same with another fit.
  const Texture& resample(const Texture& picture, hal::FrameSize size, const AspectFill& fit);

 private:
  struct Scaled {
    explicit Scaled(hal::FrameSize size);
    Texture texture;
    RenderTarget target;
  };

  Program mean_;
  Program once_;
  PerSize<Scaled> scaled_;
};

}  // namespace pleinair::gpu
