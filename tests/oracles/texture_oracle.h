#pragma once

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "pipeline/scene/models/model.h"

namespace pleinair::oracles {

/// Bilinear, of texels as linear light, whose centres are at half texels; beyond the picture as the
/// edges say (OpenGL ES 3.1, section 8.14). `place` is 0 to 1 over the picture.
glm::dvec3 sampleLinear(const scene::ModelTexture& texture, const glm::dvec2& place);

/// IEC 61966-2-1.
double srgbOf(double linear);

}  // namespace pleinair::oracles
