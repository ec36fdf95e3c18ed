#include "firmware_app/scene/attach_rotation.h"

#include <cmath>

#include <glm/trigonometric.hpp>

namespace pleinair::app {

glm::dvec3 rotationDegrees(const glm::dmat4& pose) {
  const double cosY = std::hypot(pose[0][0], pose[0][1]);
  glm::dvec3 radians(0.0, std::atan2(-pose[0][2], cosY), 0.0);
  if (cosY > 1e-9) {
    radians.x = std::atan2(pose[1][2], pose[2][2]);
    radians.z = std::atan2(pose[0][1], pose[0][0]);
  } else {
    // Gimbal lock: the axes of x and z coincide, and x takes the whole rotation.
    radians.x = std::atan2(-pose[2][1], pose[1][1]);
  }
  return glm::degrees(radians);
}

}  // namespace pleinair::app
