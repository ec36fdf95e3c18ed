#include "pipeline/gpu/resampler.h"

#include <algorithm>
#include <cassert>
#include <utility>

namespace pleinair::gpu {

Resampler::Resampler(const ShaderLibrary& library)
    : mean_(library.fragmentPass("pipeline/gpu/shaders/resample.frag")),
      once_(library.fragmentPass("pipeline/gpu/shaders/resample_once.frag")) {}

const Texture& Resampler::resample(const Texture& picture, hal::FrameSize size,
                                   const CoverFit& fit) {
  assert(picture.format() == TextureFormat::kRgba8);
  if (picture.size() == size && fit.isIdentity()) return picture;
  const Scaled& scaled = scaledOf(size);
  const bool oneTapIsEnough = fit.scale.x <= 2.0 && fit.scale.y <= 2.0;
  (oneTapIsEnough ? once_ : mean_)
      .use()
      .texture("picture", picture)
      .set("sourceOrigin", glm::vec2(fit.origin))
      .set("sourceScale", glm::vec2(fit.scale))
      .drawFullscreen(scaled.target);
  return scaled.texture;
}

const Resampler::Scaled& Resampler::scaledOf(hal::FrameSize size) {
  const auto known =
      std::ranges::find_if(scaled_, [&](const auto& each) { return each->texture.size() == size; });
  if (known != scaled_.end()) return **known;
  auto made = std::make_unique<Scaled>();
  made->texture = Texture(TextureFormat::kRgba8, size, TextureFilter::kLinear);
  made->target = RenderTarget({&made->texture});
  return *scaled_.emplace_back(std::move(made));
}

}  // namespace pleinair::gpu
