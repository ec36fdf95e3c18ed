#pragma once

#include <glm/mat4x4.hpp>

#include "pipeline/tracking/pose/pose_refinement.h"
#include "pipeline/tracking/pose/twist.h"

namespace pleinair::tracking {

/// A Kalman filter of a pose whose motion is not guessed but measured: features say, relative to
/// their key frame, how the target moved since; tags say where it is. So tags need only correct
/// what is nearly constant, and their noise is averaged away over many frames without any lag.
/// The more the target moves, and the less sure the features are, the more a tag counts.
class PoseFilter {
 public:
  /// Starts at a pose that was seen.
  void start(const PoseEstimate& seen);

  /// The target moved to `moved`, as was measured with this covariance.
  void predict(const glm::dmat4& moved, const PoseCovariance& ofMeasurement);

  /// A tag was seen. `doubt` ≥ 1 widens what was predicted, where the two do not agree.
  void correct(const PoseEstimate& seen, double doubt);

  const glm::dmat4& cameraFromTarget() const { return pose_; }
  /// Of cameraFromTarget().
  PoseCovariance covariance() const { return kept_ + measured_; }

 private:
  glm::dmat4 pose_{1.0};
  PoseCovariance kept_{};      ///< of what is carried from frame to frame
  PoseCovariance measured_{};  ///< of the last motion: not kept, as motions refer to a key frame
};

}  // namespace pleinair::tracking
