#pragma once

#include <glm/vec3.hpp>

#include "pipeline/scene/light/lighting.h"

namespace pleinair::oracles {

/// A surface in its light, sRGB-coded: `linearRgb` reflects, `normal` and `towardViewer` are unit
/// vectors of the light's frame.
///
/// Toon: thesis §3.2.2's factor, by the key light's angle or, where bands are of all light, by what
/// falls on the surface beside what could, of what is as bright as the white paper;
/// where the factor is below 1, in the ambient light's hue, (sky / its luminance) over (white / its
/// luminance), coded by a power of 1 / 2.2 and kept in 0.75 … 1.33.
glm::dvec3 toonShaded(const glm::dvec3& linearRgb, const glm::dvec3& normal,
                      const scene::Lighting& light);
/// What toon's bands are cut from, 0 … 1.
double bandIntensity(const glm::dvec3& normal, const scene::Lighting& light);
/// Smooth: Lambert in key light and a hemisphere of ambient light, and 4 % of Blinn and Phong's
/// gloss with exponent 24, normalised by (n + 8) / 8; what is brighter than white is scaled down.
glm::dvec3 smoothShaded(const glm::dvec3& linearRgb, const glm::dvec3& normal,
                        const glm::dvec3& towardViewer, const scene::Lighting& light);

}  // namespace pleinair::oracles
