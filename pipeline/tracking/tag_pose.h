#pragma once

#include <array>
#include <optional>
#include <span>

#include "pipeline/tracking/camera_model.h"
#include "pipeline/tracking/fixed_vector.h"
#include "pipeline/tracking/pose_refinement.h"
#include "pipeline/tracking/tag_frame.h"
#include "pipeline/tracking/twin_choice.h"

namespace pleinair::tracking {

/// The pose of one tag: cameraFromTarget is cameraFromTag, in the frame of tagCorners().
struct TagPose {
  PoseEstimate estimate;
  std::optional<PoseEstimate> twin;  ///< the one that was rejected
  TwinChoice choice = TwinChoice::kOnly;
  double twinEvidence = kLoneEvidence;  ///< for this one against its twin
};

/// A tag's corners in its own frame and in the picture.
std::array<Correspondence, 4> tagCorrespondences(const TagCornersPx& corners, double edgeMetres);

/// A square's pose and its twin.
using PoseCandidates = FixedVector<PoseEstimate, 2>;

/// The one or two poses that explain a tag's corners, the better fit first; none where the corners
/// are degenerate. IPPE (Collins and Bartoli, "Infinitesimal Plane-Based Pose Estimation", IJCV
/// 2014; OpenCV's SOLVEPNP_IPPE_SQUARE) on undistorted corners, both then refined in pixels.
PoseCandidates tagPoseCandidates(const CameraModel& camera, const TagCornersPx& corners,
                                 double edgeMetres);

/// One of tagPoseCandidates(), the wrong twin rejected; nothing of none. `prior`: the cameraFromTag
/// that other tags of the world or the previous frame suggest.
std::optional<TagPose> chooseTagPose(const PoseCandidates& candidates,
                                     const std::optional<PosePrior>& prior);

}  // namespace pleinair::tracking
