#pragma once

#include "pipeline/gpu/texture.h"

namespace pleinair::marks {

class MotionLayers;

/// The textures to bind for MotionLayers that may be absent: without layers, nothing is a mover and
/// the background was never seen. All calls on the thread of the GL context that was current at
/// construction.
class LayerTextures {
 public:
  /// Throws hal::Failure if GPU memory runs out.
  LayerTextures();

  /// MotionLayers::labels(), shares(), background(), activity(), moverMotion() and displacements().
  /// They belong to `layers`, or to this if that is null.
  const gpu::Texture& labelsOf(const MotionLayers* layers) const;
  const gpu::Texture& sharesOf(const MotionLayers* layers) const;
  const gpu::Texture& backgroundOf(const MotionLayers* layers) const;
  const gpu::Texture& activityOf(const MotionLayers* layers) const;
  const gpu::Texture& moverMotionOf(const MotionLayers* layers) const;
  const gpu::Texture& displacementsOf(const MotionLayers* layers) const;

 private:
  gpu::Texture none_;
};

}  // namespace pleinair::marks
