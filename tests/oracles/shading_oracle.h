#pragma once

#include <glm/vec3.hpp>

#include "pipeline/scene/light/lighting.h"

namespace pleinair::oracles {

/// The sRGB-coded colour of a lit surface: `linearRgb` is its reflectance; `normal` and
/// `towardViewer` are unit vectors of the light's frame.
///
/// Toon: the factor of thesis §3.2.2. It is computed from the key light's angle or, if the bands
/// are of all light, from the ratio of the light on the surface to the largest possible light, for
/// a surface as bright as the white paper. A factor below 1 takes the ambient light's hue, (sky /
/// its luminance) over (white / its luminance), coded by a power of 1 / 2.2 and kept in 0.75 …
/// 1.33.
glm::dvec3 toonShaded(const glm::dvec3& linearRgb, const glm::dvec3& normal,
                      const scene::Lighting& light);
/// The intensity from which toon's bands are cut, 0 … 1.
double bandIntensity(const glm::dvec3& normal, const scene::Lighting& light);
/// Smooth: Lambert under key light and hemispherical ambient light, plus 4 % of Blinn-Phong gloss
/// with exponent 24, normalised by (n + 8) / 8. Colours brighter than white are scaled down.
glm::dvec3 smoothShaded(const glm::dvec3& linearRgb, const glm::dvec3& normal,
                        const glm::dvec3& towardViewer, const scene::Lighting& light);

}  // namespace pleinair::oracles
