#pragma once

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "pipeline/scene/models/model.h"

namespace pleinair::oracles {

/// Bilinear filter over texels in linear light, with centres at half texels; outside the image, the
/// edge mode decides (OpenGL ES 3.1, section 8.14). `place` is 0 to 1 over the image.
glm::dvec3 sampleLinear(const scene::ModelTexture& texture, const glm::dvec2& place);

/// sRGB coding of linear light (IEC 61966-2-1).
double srgbOf(double linear);

}  // namespace pleinair::oracles
