#include "pipeline/tracking/pose/pose_filter.h"

#include <algorithm>
#include <iterator>

#include <glm/geometric.hpp>
#include <opencv2/core.hpp>

#include "pipeline/tracking/pose/covariance_matrix.h"

namespace pleinair::tracking {
namespace {

using Matrix6 = cv::Matx<double, 6, 6>;
using Vector6 = cv::Vec<double, 6>;

/// Relative error of a motion: depths of features are not known exactly.
constexpr double kShiftShare = 0.01;
constexpr double kTurnShare = 0.005;
/// Part of a measurement's covariance that accumulates from frame to frame.
constexpr double kAccumulatedPart = 0.01;

}  // namespace

void PoseFilter::start(const PoseEstimate& seen) {
  pose_ = seen.cameraFromTarget;
  kept_ = seen.covariance;
  measured_ = {};
}

void PoseFilter::predict(const glm::dmat4& moved, const PoseCovariance& ofMeasurement) {
  const Twist motion = motionBetween(pose_, moved);
  const glm::dmat3 turn = glm::dmat3(moved) * glm::transpose(glm::dmat3(pose_));
  kept_ = turned(kept_, turn) +
          isotropic(kTurnShare * glm::length(motion.rotation),
                    kShiftShare * glm::length(motion.shift)) +
          kAccumulatedPart * ofMeasurement;
  measured_ = ofMeasurement;
  pose_ = moved;
}

void PoseFilter::correct(const PoseEstimate& seen, double doubt) {
  const Matrix6 predicted = doubt * doubt * matrixOf(covariance());
  bool isRegular = false;
  const Matrix6 inverse =
      (predicted + matrixOf(seen.covariance)).inv(cv::DECOMP_CHOLESKY, &isRegular);
  if (!isRegular) return start(seen);
  const Matrix6 gain = predicted * inverse;
  const Twist error = motionBetween(pose_, seen.cameraFromTarget);
  const Vector6 innovation(error.rotation.x, error.rotation.y, error.rotation.z, error.shift.x,
                           error.shift.y, error.shift.z);
  const Vector6 step = gain * innovation;
  pose_ = movedBy(pose_,
                  {.rotation = {step[0], step[1], step[2]}, .shift = {step[3], step[4], step[5]}});
  // Joseph's form stays symmetric and positive.
  const Matrix6 rest = Matrix6::eye() - gain;
  kept_ = arrayOf(rest * (doubt * doubt * matrixOf(kept_)) * rest.t() +
                  gain * matrixOf(seen.covariance) * gain.t());
}

}  // namespace pleinair::tracking
