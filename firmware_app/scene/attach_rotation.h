#pragma once

#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

namespace pleinair::app {

/// A pose's rotation in degrees about the fixed axes x, then y, then z: `rotation_deg` of scene
/// files.
glm::dvec3 rotationDegrees(const glm::dmat4& pose);

}  // namespace pleinair::app
