#pragma once

#include <cstdint>

#include "hal/cameras/synthetic/render/projection.h"
#include "hal/cameras/synthetic/world/world.h"

namespace pleinair::hal::synthetic {

/// 8-bit levels in fixed point: sixty-fourths.
inline constexpr int kLevelBits = 6;
inline constexpr int kLevelSteps = 255 << kLevelBits;

/// Writes what a facet looks like at `count` pixels of row `y` from column `x` on: three sRGB-coded
/// levels each, in sixty-fourths; a fourth value is written after the last. Texels are read from
/// the two nearest mip levels, and at two points along the footprint's longer side, so that slanted
/// surfaces are neither blurred nor shimmer. Pixels beside the facet continue its surface.
void sample(const ProjectedFacet& facet, const PatchTexture& texture, int x, int y, int count,
            std::int16_t* levels);

}  // namespace pleinair::hal::synthetic
