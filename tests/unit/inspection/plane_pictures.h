#pragma once

#include <cmath>
#include <cstdint>

#include <glm/gtc/matrix_transform.hpp>
#include <glm/matrix.hpp>
#include <glm/trigonometric.hpp>

#include "hal/image.h"
#include "pipeline/tracking/camera/camera_model.h"

namespace pleinair::inspection {

inline constexpr hal::FrameSize kSize{320, 240};

/// A camera that looks at the origin from a direction about y, from a distance.
inline glm::dmat4 lookingFrom(double degrees, double rollDegrees = 0.0, double metres = 0.5) {
  return glm::translate(glm::dmat4(1.0), glm::dvec3(0, 0, metres)) *
         glm::rotate(glm::dmat4(1.0), glm::radians(rollDegrees), glm::dvec3(0, 0, 1)) *
         glm::rotate(glm::dmat4(1.0), glm::radians(degrees), glm::dvec3(0, 1, 0));
}

inline tracking::CameraModel camera() {
  return {{.fx = 400, .fy = 400, .cx = 160, .cy = 120}, {.k1 = -0.2}, kSize};
}

/// A pattern on the plane z = 0 of the machine, as the camera sees it.
inline hal::Image planeSeen(const glm::dmat4& cameraFromModel) {
  hal::Image image({.pixelFormat = hal::PixelFormat::kGrey8, .size = kSize});
  const glm::dmat4 modelFromCamera = glm::inverse(cameraFromModel);
  for (int y = 0; y < kSize.height; ++y) {
    for (int x = 0; x < kSize.width; ++x) {
      const auto ray = camera().unproject({x + 0.5, y + 0.5});
      if (!ray) continue;
      const glm::dvec3 eye(modelFromCamera[3]);
      const glm::dvec3 direction = glm::dmat3(modelFromCamera) * *ray;
      const glm::dvec3 hit = eye - eye.z / direction.z * direction;
      image.row(0, y)[static_cast<std::size_t>(x)] =
          static_cast<std::uint8_t>(128 + 60 * std::sin(180 * hit.x) + 50 * std::cos(150 * hit.y));
    }
  }
  return image;
}

}  // namespace pleinair::inspection
