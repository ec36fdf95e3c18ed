#include "pipeline/tracking/pose/twist.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>
#include <opencv2/core.hpp>

#include "pipeline/tracking/pose/covariance_matrix.h"

namespace pleinair::tracking {
namespace {

/// [v]×: its product with a vector is the cross product.
cv::Matx33d crossMatrix(const glm::dvec3& v) {
  return {0.0, -v.z, v.y, v.z, 0.0, -v.x, -v.y, v.x, 0.0};
}

/// Removes rounding errors from an orthonormal basis.
glm::dmat3 orthonormal(const glm::dmat3& m) {
  const glm::dvec3 x = glm::normalize(m[0]);
  const glm::dvec3 z = glm::normalize(glm::cross(x, m[1]));
  return {x, glm::cross(z, x), z};
}

/// Rodrigues' formula.
glm::dvec3 rotated(const glm::dvec3& v, const glm::dvec3& axis, double angle) {
  return v * std::cos(angle) + glm::cross(axis, v) * std::sin(angle) +
         axis * glm::dot(axis, v) * (1.0 - std::cos(angle));
}

}  // namespace

glm::dmat4 movedBy(const glm::dmat4& pose, const Twist& motion) {
  glm::dmat3 rotation(pose);
  const double angle = glm::length(motion.rotation);
  if (angle > 0.0) {
    const glm::dvec3 axis = motion.rotation / angle;
    for (int i = 0; i < 3; ++i) rotation[i] = rotated(rotation[i], axis, angle);
    rotation = orthonormal(rotation);
  }
  glm::dmat4 out(rotation);
  out[3] = glm::dvec4(glm::dvec3(pose[3]) + motion.shift, 1.0);
  return out;
}

Twist motionBetween(const glm::dmat4& from, const glm::dmat4& to) {
  const glm::dmat3 r = glm::dmat3(to) * glm::transpose(glm::dmat3(from));
  // The skew part is sin(angle) · axis; glm's m[column][row].
  const glm::dvec3 sine = 0.5 * glm::dvec3(r[1][2] - r[2][1], r[2][0] - r[0][2], r[0][1] - r[1][0]);
  const double cosine = 0.5 * (r[0][0] + r[1][1] + r[2][2] - 1.0);
  const double length = glm::length(sine);
  const double angle = std::atan2(length, cosine);
  return {.rotation = length > 1e-12 ? sine * (angle / length) : sine,
          .shift = glm::dvec3(to[3] - from[3])};
}

glm::dmat4 rigidInverse(const glm::dmat4& pose) {
  const glm::dmat3 back = glm::transpose(glm::dmat3(pose));
  glm::dmat4 out(back);
  out[3] = glm::dvec4(-(back * glm::dvec3(pose[3])), 1.0);
  return out;
}

PoseCovariance atPoint(const PoseCovariance& covariance, const glm::dvec3& arm) {
  Matrix6 change = Matrix6::eye();
  const cv::Matx33d byRotation = -crossMatrix(arm);  // ω × arm
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) change(row + 3, column) = byRotation(row, column);
  }
  return arrayOf(change * matrixOf(covariance) * change.t());
}

PoseCovariance turned(const PoseCovariance& covariance, const glm::dmat3& rotation) {
  Matrix6 change = Matrix6::zeros();
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) {
      change(row, column) = rotation[column][row];
      change(row + 3, column + 3) = rotation[column][row];
    }
  }
  return arrayOf(change * matrixOf(covariance) * change.t());
}

PoseCovariance operator+(const PoseCovariance& a, const PoseCovariance& b) {
  PoseCovariance sum{};
  for (std::size_t i = 0; i < sum.size(); ++i) sum[i] = a[i] + b[i];
  return sum;
}

PoseCovariance operator*(double factor, const PoseCovariance& covariance) {
  PoseCovariance out = covariance;
  for (double& value : out) value *= factor;
  return out;
}

PoseCovariance isotropic(double rotationRad, double shiftMetres) {
  PoseCovariance out{};
  for (std::size_t i = 0; i < 3; ++i) {
    out[7 * i] = rotationRad * rotationRad;
    out[7 * (i + 3)] = shiftMetres * shiftMetres;
  }
  return out;
}

double projectedVariancePx(const CameraModel& camera, const glm::dmat4& cameraFromTarget,
                           const PoseCovariance& covariance, std::span<const glm::dvec3> points) {
  double sum = 0.0;
  const Matrix6 c = matrixOf(covariance);
  for (const glm::dvec3& point : points) {
    const glm::dvec3 arm = glm::dmat3(cameraFromTarget) * point;
    const glm::dvec3 inCamera = arm + glm::dvec3(cameraFromTarget[3]);
    const glm::dmat3x2 pxBy = camera.projectWithJacobian(inCamera).pxByCameraPoint;
    cv::Matx<double, 2, 6> jacobian;
    for (int axis = 0; axis < 3; ++axis) {
      glm::dvec3 unit(0.0);
      unit[axis] = 1.0;
      const glm::dvec2 byTurn = pxBy * glm::cross(unit, arm);
      for (int row = 0; row < 2; ++row) {
        jacobian(row, axis) = byTurn[row];
        jacobian(row, axis + 3) = pxBy[axis][row];
      }
    }
    sum += cv::trace(jacobian * c * jacobian.t());
  }
  return sum / static_cast<double>(points.size());
}

}  // namespace pleinair::tracking
