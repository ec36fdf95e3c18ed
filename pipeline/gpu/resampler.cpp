#include "pipeline/gpu/resampler.h"

#include <cassert>
#include <utility>

#include "pipeline/gpu/cover_fit.h"

namespace pleinair::gpu {

Resampler::Resampler(const ShaderLibrary& library)
    : program_(library.fragmentPass("pipeline/gpu/shaders/resample.frag")) {}

const Texture& Resampler::resample(const Texture& picture, hal::FrameSize size) {
  assert(picture.format() == TextureFormat::kRgba8);
  if (picture.size() == size) return picture;
  if (scaled_.size() != size) {
    scaled_ = Texture();  // stays empty where there is no memory for the new one
    Texture scaled(TextureFormat::kRgba8, size, TextureFilter::kLinear);
    target_ = RenderTarget({&scaled});
    scaled_ = std::move(scaled);
  }
  const CoverFit fit = coverFit(picture.size(), size);
  program_.use()
      .texture("picture", picture)
      .set("sourceOrigin", glm::vec2(fit.origin))
      .set("sourceScale", glm::vec2(fit.scale))
      .drawFullscreen(target_);
  return scaled_;
}

}  // namespace pleinair::gpu
