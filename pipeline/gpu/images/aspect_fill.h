#pragma once

#include <glm/vec2.hpp>

#include "hal/pixel_format.h"

namespace pleinair::gpu {

/// The mapping that scales a picture to cover a target of another size, centred, with the aspect
/// kept and the overhang cut off. source px = origin + scale · target px, pixel centres at +0.5.
struct AspectFill {
  glm::dvec2 origin{0.0};
  glm::dvec2 scale{1.0};

  /// The same fit where the two pictures have other pixels: so many new ones for an old one.
  AspectFill withPixels(const glm::dvec2& ofSource, const glm::dvec2& ofTarget) const {
    return {.origin = origin * ofSource, .scale = scale * ofSource / ofTarget};
  }
  /// Whether it leaves a picture of the target's size as it is, but for rounding.
  bool isIdentity() const;
};

/// The aspect fill of a target with a source. Precondition: both have pixels.
AspectFill aspectFill(hal::FrameSize source, hal::FrameSize target);

}  // namespace pleinair::gpu
