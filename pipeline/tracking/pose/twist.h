#pragma once

#include <array>

#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

#include "pipeline/tracking/pose/pose_refinement.h"

namespace pleinair::tracking {

/// A small motion of a pose's target in camera axes (an se(3) increment): a rotation vector about
/// the target's origin (rad), then a shift (metres). PoseCovariance is the covariance of a twist.
struct Twist {
  glm::dvec3 rotation{0.0};
  glm::dvec3 shift{0.0};

  friend Twist operator*(double part, const Twist& motion) {
    return {part * motion.rotation, part * motion.shift};
  }
  friend Twist operator+(const Twist& a, const Twist& b) {
    return {a.rotation + b.rotation, a.shift + b.shift};
  }
};

glm::dmat4 movedBy(const glm::dmat4& pose, const Twist& motion);
/// The twist that moves `from` to `to`.
Twist motionBetween(const glm::dmat4& from, const glm::dmat4& to);
/// Inverse of a rigid pose.
glm::dmat4 rigidInverse(const glm::dmat4& pose);

/// Covariance of the same motion at another point of the target, `arm` from its origin in camera
/// axes: a turn about one point shifts the other.
PoseCovariance atPoint(const PoseCovariance& covariance, const glm::dvec3& arm);
/// The covariance in axes turned by `rotation`.
PoseCovariance turned(const PoseCovariance& covariance, const glm::dmat3& rotation);
PoseCovariance operator+(const PoseCovariance& a, const PoseCovariance& b);
PoseCovariance operator*(double factor, const PoseCovariance& covariance);
/// Covariance of independent errors with these standard deviations.
PoseCovariance isotropic(double rotationRad, double shiftMetres);

/// Predicted mean squared error (px²) of a target's projected points.
double projectedVariancePx(const CameraModel& camera, const glm::dmat4& cameraFromTarget,
                           const PoseCovariance& covariance, std::span<const glm::dvec3> points);

}  // namespace pleinair::tracking
