#include "pipeline/gpu/images/resampler.h"

#include <cassert>
#include <utility>

namespace pleinair::gpu {

Resampler::Resampler(const ShaderLibrary& library)
    : mean_(library.fragmentPass("pipeline/gpu/images/shaders/resample.frag")),
      once_(library.fragmentPass("pipeline/gpu/images/shaders/resample_once.frag")) {}

const Texture& Resampler::resample(const Texture& picture, hal::FrameSize size,
                                   const AspectFill& fit) {
  assert(picture.format() == TextureFormat::kRgba8);
  if (picture.size() == size && fit.isIdentity()) return picture;
  const Scaled& scaled = scaled_.of(size, size);
  const bool oneTapIsEnough = fit.scale.x <= 2.0 && fit.scale.y <= 2.0;
  (oneTapIsEnough ? once_ : mean_)
      .use()
      .texture("picture", picture)
      .set("sourceOrigin", glm::vec2(fit.origin))
      .set("sourceScale", glm::vec2(fit.scale))
      .drawFullscreen(scaled.target);
  return scaled.texture;
}

Resampler::Scaled::Scaled(hal::FrameSize size)
    : texture(TextureFormat::kRgba8, size, TextureFilter::kLinear), target({&texture}) {}

}  // namespace pleinair::gpu
