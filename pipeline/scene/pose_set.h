#pragma once

#include <optional>
#include <span>

#include <glm/mat4x4.hpp>

#include "pipeline/tracking/pose_refinement.h"

namespace pleinair::scene {

/// A tag that is seen, and where: OpenCV's camera frame from tracking's tag frame
/// (tracking::TrackedTag::cameraFromTag, which agrees with the world's pose where the tag does).
struct TagSighting {
  int id = 0;
  glm::dmat4 cameraFromTag{1.0};
  tracking::PoseCovariance covariance{};
};

/// What one frame knows of poses. Refers to the sightings' memory.
struct PoseSet {
  std::optional<glm::dmat4> cameraFromWorld;
  tracking::PoseCovariance worldCovariance{};
  std::span<const TagSighting> tags;
};

}  // namespace pleinair::scene
