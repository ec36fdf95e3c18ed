#pragma once

#include <glm/vec3.hpp>

namespace pleinair::scene {

/// The distant light and the uniform light that best explain the workbench's light at a point.
struct BenchLight {
  glm::dvec3 towardKey{0.0};  ///< unit, in the world
  glm::dvec3 key{0.0};        ///< on a surface that faces it, linear RGB
  glm::dvec3 ambient{0.0};
  glm::dvec3 onPlane{0.0};  ///< on a surface with normal `up`
};

/// Ground truth at a point of the workbench, from its own lights: the irradiance of surfaces in all
/// directions of the half space of `up`, fitted by least squares.
BenchLight benchLightAt(const glm::dvec3& point, const glm::dvec3& up);

/// Irradiance of a surface there, linear RGB.
glm::dvec3 benchIrradiance(const glm::dvec3& point, const glm::dvec3& normal);

}  // namespace pleinair::scene
