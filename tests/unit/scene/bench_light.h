#pragma once

#include <glm/vec3.hpp>

namespace pleinair::scene {

/// One far light and an even one, as they explain the workbench's light at a point best.
struct BenchLight {
  glm::dvec3 towardKey{0.0};  ///< unit, in the world
  glm::dvec3 key{0.0};        ///< on a surface that faces it, linear RGB
  glm::dvec3 ambient{0.0};
  glm::dvec3 onPlane{0.0};  ///< on a surface that faces `up`
};

/// The truth at a point of the workbench, from its own light: what falls on surfaces there that
/// face all ways of the half space of `up`, fitted by least squares.
BenchLight benchLightAt(const glm::dvec3& point, const glm::dvec3& up);

/// What falls on a surface there, linear RGB.
glm::dvec3 benchIrradiance(const glm::dvec3& point, const glm::dvec3& normal);

}  // namespace pleinair::scene
