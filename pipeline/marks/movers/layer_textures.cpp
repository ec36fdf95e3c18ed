#include "pipeline/marks/movers/layer_textures.h"

#include <cstddef>
#include <cstdint>
#include <vector>

#include "pipeline/marks/movers/motion_layers.h"

namespace pleinair::marks {

LayerTextures::LayerTextures()
    : none_(gpu::TextureFormat::kRgba16f, {1, 1}, gpu::TextureFilter::kLinear) {
  constexpr std::size_t kTexelBytes = 8;
  none_.upload(std::vector<std::uint8_t>(kTexelBytes), kTexelBytes);
}

const gpu::Texture& LayerTextures::labelsOf(const MotionLayers* layers) const {
  return layers != nullptr ? layers->labels() : none_;
}

const gpu::Texture& LayerTextures::sharesOf(const MotionLayers* layers) const {
  return layers != nullptr ? layers->shares() : none_;
}

const gpu::Texture& LayerTextures::backgroundOf(const MotionLayers* layers) const {
  return layers != nullptr ? layers->background() : none_;
}

const gpu::Texture& LayerTextures::activityOf(const MotionLayers* layers) const {
  return layers != nullptr ? layers->activity() : none_;
}

const gpu::Texture& LayerTextures::moverMotionOf(const MotionLayers* layers) const {
  return layers != nullptr ? layers->moverMotion() : none_;
}

const gpu::Texture& LayerTextures::displacementsOf(const MotionLayers* layers) const {
  return layers != nullptr ? layers->displacements() : none_;
}

}  // namespace pleinair::marks
