#pragma once

#include <optional>
#include <span>
#include <vector>

#include <glm/mat4x4.hpp>

#include "pipeline/tracking/camera_model.h"
#include "pipeline/tracking/pose_refinement.h"
#include "pipeline/tracking/tag_frame.h"
#include "pipeline/tracking/twin_choice.h"

namespace pleinair::tracking {

/// A tag whose place in the world is known, and how the picture shows it.
struct WorldTag {
  glm::dmat4 worldFromTag{1.0};
  double edgeMetres = 0.0;
  TagCornersPx corners{};
  std::vector<PoseEstimate> candidates;  ///< tagPoseCandidates()
};

struct WorldPose {
  PoseEstimate estimate;  ///< cameraFromTarget is cameraFromWorld
  TwinChoice choice = TwinChoice::kOnly;
  double twinEvidence = kLoneEvidence;  ///< for this one against its twin
  std::vector<bool> agrees;             ///< for each tag: it was used; the others contradict it
};

/// The camera's pose from all tags together. Each tag's poses, twins included, are hypotheses; the
/// two that explain all tags best are refined over all their corners, tags that contradict are left
/// out, and the wrong one of the two is rejected as for a single tag. Nothing where no tag has a
/// pose.
std::optional<WorldPose> solveWorldPose(const CameraModel& camera, std::span<const WorldTag> tags,
                                        const std::optional<PosePrior>& prior);

}  // namespace pleinair::tracking
