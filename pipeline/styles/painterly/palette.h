#pragma once

#include <string_view>
#include <vector>

#include <glm/vec3.hpp>

#include "pipeline/gpu/texture.h"

namespace pleinair::styles {

/// The pigments that a painting may be mixed of: sRGB-coded in [0, 1]; none: any colour.
using Pigments = std::vector<glm::vec3>;

/// The texts that isPalette() accepts, in words.
inline constexpr const char* kPaletteAllowed =
    "all, zorn, earth, primaries, sepia, or 2 to 8 colours as \"#rrggbb #rrggbb …\"";
/// Whether a text names a palette or lists pigments.
bool isPalette(std::string_view text);
/// Precondition: isPalette(text).
Pigments pigmentsOf(std::string_view text);

/// The colour nearest to `colour` that the pigments can be mixed to: the nearest point of their
/// convex hull, brightness weighing more than hue. Neighbours stay neighbours, so that a limited
/// palette makes nothing flicker. Without pigments: itself.
glm::vec3 mixedOf(const Pigments& pigments, const glm::vec3& colour);

inline constexpr int kMixtures = 17;  ///< that a side of the look-up has
/// mixedOf() for all colours, for shaders/mixture.glsl: RGBA8, kMixtures slices of constant blue
/// beside each other, red to the right, green down. On the thread of a GL context.
gpu::Texture makeMixtures(const Pigments& pigments);

}  // namespace pleinair::styles
