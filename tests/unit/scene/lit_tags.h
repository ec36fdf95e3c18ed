#pragma once

#include <cstdint>
#include <vector>

#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "hal/image.h"
#include "pipeline/tracking/camera/camera_model.h"
#include "pipeline/tracking/pose/tracker.h"

namespace pleinair::scene {

/// A distant light and uniform ambient light, in the world; on white paper, linear.
struct RoomOfTags {
  glm::dvec3 towardKey{0.0, 0.0, 1.0};
  glm::dvec3 key{0.5};
  glm::dvec3 ambient{0.2};
  glm::dvec3 background{0.2};  ///< colour of the background as it appears
  /// Doublings of the background's brightness from the image's centre to its edges.
  glm::dvec2 backgroundSlope{0.0};
  std::vector<tracking::TagMarker> tags;
  double ink = 0.05;  ///< relative to the paper
};

struct Shot {
  glm::dmat4 cameraFromWorld{1.0};
  glm::dvec3 gain{1.0};  ///< of the camera, in linear light
};

tracking::CameraModel tagCamera();

/// An upright camera at `metres` from the origin of the world, `downDegrees` above its plane z = 0
/// and `aroundDegrees` from its −y.
glm::dmat4 lookingAtOrigin(double metres, double downDegrees, double aroundDegrees);

/// A tag rotated in the world about x, then z; with both at 0 it lies in the world's plane.
tracking::TagMarker placedTag(int id, const glm::dvec3& at, double aboutX, double aboutZ);

/// RGB8; tags have a white border, a black one, and grey in place of their code.
hal::Image pictureOf(const RoomOfTags& room, const Shot& shot);

/// The same with sensor noise; `sigma` in 8-bit levels.
hal::Image noisy(const hal::Image& image, std::uint32_t seed, double sigma = 2.0);

/// The tracking result without error. Refers to `tags`.
struct Tracked {
  std::vector<tracking::TrackedTag> tags;
  glm::dmat4 cameraFromWorld{1.0};

  tracking::TrackingResult result() const {
    return {.tags = tags, .cameraFromWorld = cameraFromWorld};
  }
};
Tracked trackedIn(const RoomOfTags& room, const Shot& shot);

}  // namespace pleinair::scene
