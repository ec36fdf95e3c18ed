#pragma once

#include <array>
#include <vector>

#include <glm/vec3.hpp>

#include "hal/cameras/synthetic/world/builder.h"

namespace pleinair::hal::synthetic {

using Occluders = std::vector<const Occluder*>;

/// The distance, in units of `direction`, at which a ray enters an occluder, or infinity.
float entryDistance(const Occluder& occluder, glm::vec3 origin, glm::vec3 direction);
/// Whether the ray enters an occluder before `distance` units of its direction.
bool isBlocked(const Occluders& near, glm::vec3 origin, glm::vec3 direction, float distance);

bool isInside(const Occluder& occluder, glm::vec3 point);

/// A part of a patch's lattice.
struct Tile {
  std::array<glm::vec3, 4> corners{};
  glm::vec3 centre{0}, normal{0};
  float radius = 0;
  bool isFlat = false;
};

/// The occluders that a ray from the tile to within `farRadius` of `to` may meet.
Occluders between(const Occluders& occluders, const Tile& tile, glm::vec3 to, float farRadius);

/// The occluders near the tile and not behind it.
Occluders around(const Occluders& occluders, const Tile& tile, float withinMetres);

}  // namespace pleinair::hal::synthetic
