#pragma once

#include <glm/mat4x4.hpp>

#include "pipeline/tracking/pose/pose_refinement.h"
#include "pipeline/tracking/pose/twist.h"

namespace pleinair::tracking {

/// A Kalman filter of a pose with measured motion: features give the target's motion relative to
/// their key frame, tags give its position. Tags therefore correct only a nearly constant quantity,
/// and their noise is averaged over many frames without lag. A tag weighs more the more the target
/// moves and the less certain the features are.
class PoseFilter {
 public:
  /// Starts at a pose that was seen.
  void start(const PoseEstimate& seen);

  /// Moves the target to `moved`, measured with this covariance.
  void predict(const glm::dmat4& moved, const PoseCovariance& ofMeasurement);

  /// Corrects the pose by a tag that was seen. `doubt` ≥ 1 widens the predicted covariance where
  /// the two addDisagreement.
  void correct(const PoseEstimate& seen, double doubt);

  const glm::dmat4& cameraFromTarget() const { return pose_; }
  /// Covariance of cameraFromTarget().
  PoseCovariance covariance() const { return kept_ + measured_; }

 private:
  glm::dmat4 pose_{1.0};
  PoseCovariance kept_{};  ///< accumulated from frame to frame
  /// Covariance of the last motion; not accumulated, since motions refer to a key frame.
  PoseCovariance measured_{};
};

}  // namespace pleinair::tracking
