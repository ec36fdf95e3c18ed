#pragma once

#include <optional>

#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "hal/pixel_format.h"

namespace pleinair::hal {

/// A pinhole without distortion, in pixels; the first pixel's centre is at (0.5, 0.5).
struct PinholeIntrinsics {
  double fx = 0, fy = 0;
  double cx = 0, cy = 0;
};

/// The synthetic camera's: square pixels, about 56° across the longer side, the axis in the middle.
PinholeIntrinsics syntheticIntrinsics(FrameSize size);

}  // namespace pleinair::hal

namespace pleinair::hal::synthetic {

/// A line of sight, in world coordinates; the direction's length is not 1.
struct Ray {
  glm::dvec3 origin{0};
  glm::dvec3 direction{0};
};

/// A camera at one moment.
struct CameraView {
  PinholeIntrinsics intrinsics;
  glm::dmat4 cameraFromWorld{1};  ///< rigid; OpenCV's camera frame

  /// The point it looks from, in the world.
  glm::dvec3 eye() const;
  /// Where a world point appears, px; nothing where it is behind the camera.
  std::optional<glm::dvec2> project(glm::dvec3 world) const;
  /// What may be seen at a pixel coordinate.
  Ray through(glm::dvec2 pixel) const;
};

}  // namespace pleinair::hal::synthetic
