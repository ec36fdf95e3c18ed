#pragma once

#include <span>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "hal/pixel_format.h"
#include "pipeline/scene/models/mesh.h"
#include "pipeline/tracking/camera/camera_model.h"

namespace pleinair::scene {

/// A rectangle of an image's pixels; empty if a side is 0.
struct ScreenArea {
  glm::ivec2 origin{0};
  glm::ivec2 size{0};

  bool isEmpty() const { return size.x <= 0 || size.y <= 0; }
};

/// The part of the image that a convex body may cover, given corners of a hull around it (camera
/// frame, metres). It is never too small; it is the whole image if a corner is beside or behind the
/// camera.
ScreenArea areaAround(std::span<const glm::dvec3> cameraCorners,
                      const tracking::CameraModel& camera);

/// The part of the image that a ball may cover.
ScreenArea areaAround(const BoundingSphere& cameraBall, const tracking::CameraModel& camera);

/// The bounding rectangle of both; an empty one adds nothing.
ScreenArea unionOf(const ScreenArea& a, const ScreenArea& b);

}  // namespace pleinair::scene
