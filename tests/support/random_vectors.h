#pragma once

#include <glm/glm.hpp>

namespace pleinair::support {

// The arguments of one call have no order: gcc draws them from the last on x86, from the first on
// arm64. Vectors drawn here are the same on both.

template <class Distribution, class Engine>
glm::dvec2 randomVec2(Distribution& distribution, Engine& engine) {
  const double y = distribution(engine);
  return {distribution(engine), y};
}

template <class Distribution, class Engine>
glm::dvec3 randomVec3(Distribution& distribution, Engine& engine) {
  const double z = distribution(engine);
  const double y = distribution(engine);
  return {distribution(engine), y, z};
}

}  // namespace pleinair::support
