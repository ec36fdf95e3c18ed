#pragma once

#include <glm/gtc/matrix_transform.hpp>
#include <glm/mat4x4.hpp>

#include "pipeline/tracking/camera/camera_model.h"

namespace pleinair::overlay {

/// A camera of 640 × 480 px, of 60° or so.
inline tracking::CameraModel testCamera() {
  return {{.fx = 560.0, .fy = 560.0, .cx = 320.0, .cy = 240.0}, {}, {640, 480}};
}

/// A model straight ahead, its z towards the camera, turned about the camera's upright.
inline glm::dmat4 ahead(double metres, double turnDeg = 0.0) {
  const glm::dmat4 place = glm::translate(glm::dmat4(1.0), {0.0, 0.0, metres});
  const glm::dmat4 turned = glm::rotate(place, glm::radians(turnDeg), {0.0, 1.0, 0.0});
  return glm::rotate(turned, glm::radians(180.0), {1.0, 0.0, 0.0});
}

}  // namespace pleinair::overlay
