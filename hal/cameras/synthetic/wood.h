#pragma once

#include <cstdint>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

namespace pleinair::hal::synthetic {

/// Oiled planks along x, worn by work, with grain and a few knots: linear light at a point in
/// metres.
glm::vec3 woodLinearRgb(std::uint32_t seed, glm::vec2 point);

}  // namespace pleinair::hal::synthetic
