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

/// One far light and an even one, in the world; on white paper, linear.
struct RoomOfTags {
  glm::dvec3 towardKey{0.0, 0.0, 1.0};
  glm::dvec3 key{0.5};
  glm::dvec3 ambient{0.2};
  glm::dvec3 background{0.2};  ///< what is seen beside the tags, as it appears
  /// Doublings of the background from the picture's middle to its edges.
  glm::dvec2 backgroundSlope{0.0};
  std::vector<tracking::TagMarker> tags;
  double ink = 0.05;  ///< beside the paper
};

struct Shot {
  glm::dmat4 cameraFromWorld{1.0};
  glm::dvec3 gain{1.0};  ///< the camera's, in linear light
};

tracking::CameraModel tagCamera();

/// At `metres` from the origin of the world, `downDegrees` over its plane z = 0 and `aroundDegrees`
/// from its −y; upright.
glm::dmat4 lookingAtOrigin(double metres, double downDegrees, double aroundDegrees);

/// A tag that is turned in the world (about x, then z) and lies in its plane where both are 0.
tracking::TagMarker placedTag(int id, const glm::dvec3& at, double aboutX, double aboutZ);

/// RGB8; tags have a white border, a black one, and grey for their code.
hal::Image pictureOf(const RoomOfTags& room, const Shot& shot);

/// The same through a noisy sensor; `sigma` in 8-bit levels.
hal::Image noisy(const hal::Image& image, std::uint32_t seed, double sigma = 2.0);

/// What tracking says of it, without error. Belongs to `tags`.
struct Tracked {
  std::vector<tracking::TrackedTag> tags;
  glm::dmat4 cameraFromWorld{1.0};

  tracking::TrackingResult result() const {
    return {.tags = tags, .cameraFromWorld = cameraFromWorld};
  }
};
Tracked trackedIn(const RoomOfTags& room, const Shot& shot);

}  // namespace pleinair::scene
