#pragma once

#include <cstdint>

#include "hal/cameras/synthetic/render/projection.h"
#include "hal/cameras/synthetic/world/world.h"

namespace pleinair::hal::synthetic {

/// Fraction bits of an 8-bit level in fixed point: a unit is a sixty-fourth.
inline constexpr int kLevelBits = 6;
inline constexpr int kLevelSteps = 255 << kLevelBits;

/// Samples a facet at `count` pixels of row `y` from column `x` on: three sRGB-coded levels each,
/// in sixty-fourths; a fourth value is written after the last pixel. Filters between the two
/// nearest mip levels and between two taps along the footprint's longer side, so that slanted
/// surfaces neither blur nor flicker. Pixels outside the facet continue its surface.
void sample(const ProjectedFacet& facet, const PatchTexture& texture, int x, int y, int count,
            std::int16_t* levels);

}  // namespace pleinair::hal::synthetic
