#include "pipeline/tracking/pose/pose_refinement.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <opencv2/core.hpp>

#include "pipeline/tracking/pose/covariance_matrix.h"

namespace pleinair::tracking {
namespace {

using Vector6 = cv::Vec<double, 6>;

constexpr double kNearestMetres = 1e-4;
constexpr double kMinCornerNoisePx = 0.1;
constexpr int kMaxSteps = 30;
constexpr double kStepTolerance = 1e-10;  // rad and metres

/// Normal equations of Gauss–Newton at a pose, and its robust cost.
struct NormalEquations {
  Matrix6 matrix = Matrix6::zeros();
  Vector6 gradient = Vector6::all(0.0);
  double cost = 0.0;
};

double huberCost(double distance, double huberPx) {
  return distance <= huberPx ? distance * distance : huberPx * (2.0 * distance - huberPx);
}

double robustCost(const CameraModel& camera, std::span<const Correspondence> points,
                  const glm::dmat4& pose, double huberPx) {
  double cost = 0.0;
  for (const Correspondence& point : points) {
    const glm::dvec3 inCamera = transform(pose, point.target);
    if (!(inCamera.z > kNearestMetres)) return std::numeric_limits<double>::infinity();
    const glm::dvec2 error = point.whitening * (camera.project(inCamera) - point.px);
    cost += huberCost(glm::length(error), huberPx);
  }
  return cost;
}

NormalEquations normalEquations(const CameraModel& camera, std::span<const Correspondence> points,
                                const glm::dmat4& pose, double huberPx) {
  NormalEquations out;
  const glm::dvec3 origin(pose[3]);
  for (const Correspondence& point : points) {
    const glm::dvec3 inCamera = transform(pose, point.target);
    const Projection shown = camera.projectWithJacobian(inCamera);
    const glm::dvec2 error = point.whitening * (shown.px - point.px);
    const glm::dmat3x2 pxByCameraPoint = point.whitening * shown.pxByCameraPoint;
    const double distance = glm::length(error);
    const double weight = distance <= huberPx ? 1.0 : huberPx / distance;
    out.cost += huberCost(distance, huberPx);

    std::array<glm::dvec2, 6> columns{};
    const glm::dvec3 arm = inCamera - origin;
    for (int axis = 0; axis < 3; ++axis) {
      glm::dvec3 unit(0.0);
      unit[axis] = 1.0;
      columns[static_cast<std::size_t>(axis)] = pxByCameraPoint * glm::cross(unit, arm);
      columns[static_cast<std::size_t>(axis) + 3] = pxByCameraPoint[axis];
    }
    for (int row = 0; row < 6; ++row) {
      const glm::dvec2& byRow = columns[static_cast<std::size_t>(row)];
      out.gradient[row] += weight * glm::dot(byRow, error);
      for (int column = 0; column < 6; ++column) {
        out.matrix(row, column) +=
            weight * glm::dot(byRow, columns[static_cast<std::size_t>(column)]);
      }
    }
  }
  return out;
}

/// Rotates by a rotation vector about the target's origin (Rodrigues), then shifts.
glm::dmat4 moved(const glm::dmat4& pose, const Vector6& step) {
  const glm::dvec3 vector(step[0], step[1], step[2]);
  const double angle = glm::length(vector);
  glm::dmat4 out = pose;
  for (int column = 0; column < 3 && angle > 0.0; ++column) {
    const glm::dvec3 axis = vector / angle;
    const glm::dvec3 v(pose[column]);
    out[column] = glm::dvec4(v * std::cos(angle) + glm::cross(axis, v) * std::sin(angle) +
                                 axis * glm::dot(axis, v) * (1.0 - std::cos(angle)),
                             0.0);
  }
  out[3] += glm::dvec4(step[3], step[4], step[5], 0.0);
  return out;
}

/// Removes the rounding errors that accumulate over the steps.
glm::dmat4 orthonormalised(const glm::dmat4& pose) {
  const glm::dvec3 x = glm::normalize(glm::dvec3(pose[0]));
  const glm::dvec3 z = glm::normalize(glm::cross(x, glm::dvec3(pose[1])));
  return {glm::dvec4(x, 0.0), glm::dvec4(glm::cross(z, x), 0.0), glm::dvec4(z, 0.0), pose[3]};
}

std::optional<Vector6> dampedStep(const NormalEquations& equations, double damping) {
  Matrix6 damped = equations.matrix;
  for (int i = 0; i < 6; ++i) damped(i, i) *= 1.0 + damping;
  Vector6 step;
  if (!cv::solve(damped, -equations.gradient, step, cv::DECOMP_CHOLESKY)) return std::nullopt;
  return step;
}

/// σ² (JᵀJ)⁻¹ with σ from the residuals and the remaining degrees of freedom.
std::optional<std::array<double, 36>> covarianceOf(const Matrix6& normal, double squaredError,
                                                   std::size_t pointCount) {
  bool isRegular = false;
  const Matrix6 inverse = normal.inv(cv::DECOMP_CHOLESKY, &isRegular);
  if (!isRegular) return std::nullopt;
  const double freedom = std::max(1.0, 2.0 * static_cast<double>(pointCount) - 6.0);
  const double variance = std::max(squaredError / freedom, kMinCornerNoisePx * kMinCornerNoisePx);
  std::array<double, 36> covariance{};
  for (std::size_t i = 0; i < covariance.size(); ++i) covariance[i] = variance * inverse.val[i];
  return covariance;
}

}  // namespace

double PoseEstimate::rotationSigmaRad() const {
  return std::sqrt(covariance[0] + covariance[7] + covariance[14]);
}

double PoseEstimate::translationSigmaMetres() const {
  return std::sqrt(covariance[21] + covariance[28] + covariance[35]);
}

std::optional<PoseEstimate> refinePose(const CameraModel& camera,
                                       std::span<const Correspondence> points,
                                       const glm::dmat4& startCameraFromTarget, double huberPx) {
  glm::dmat4 pose = startCameraFromTarget;
  if (points.size() < 3 || !std::isfinite(robustCost(camera, points, pose, huberPx))) {
    return std::nullopt;
  }
  double damping = 1e-4;
  NormalEquations now = normalEquations(camera, points, pose, huberPx);
  for (int stepCount = 0; stepCount < kMaxSteps && damping < 1e8; ++stepCount) {
    const std::optional<Vector6> step = dampedStep(now, damping);
    if (!step) {
      damping *= 10.0;
      continue;
    }
    const glm::dmat4 next = moved(pose, *step);
    const double cost = robustCost(camera, points, next, huberPx);
    const bool isConverged = cv::norm(*step) < kStepTolerance;
    if (cost <= now.cost) {
      pose = orthonormalised(next);
      now = normalEquations(camera, points, pose, huberPx);
      damping = std::max(damping * 0.1, 1e-12);
    } else {
      damping *= 10.0;
    }
    if (isConverged) break;
  }

  const double squaredError = squaredErrorPx(camera, points, pose);
  const double whitened = robustCost(camera, points, pose, std::numeric_limits<double>::infinity());
  const auto covariance = covarianceOf(now.matrix, whitened, points.size());
  if (!covariance || !std::isfinite(squaredError)) return std::nullopt;
  return PoseEstimate{.cameraFromTarget = pose,
                      .rmsPx = std::sqrt(squaredError / static_cast<double>(points.size())),
                      .covariance = *covariance};
}

double squaredErrorPx(const CameraModel& camera, std::span<const Correspondence> points,
                      const glm::dmat4& cameraFromTarget) {
  double sum = 0.0;
  for (const Correspondence& point : points) {
    const glm::dvec3 inCamera = transform(cameraFromTarget, point.target);
    if (!(inCamera.z > kNearestMetres)) return std::numeric_limits<double>::infinity();
    const glm::dvec2 error = camera.project(inCamera) - point.px;
    sum += glm::dot(error, error);
  }
  return sum;
}

double rotationBetweenRad(const glm::dmat4& a, const glm::dmat4& b) {
  double squared = 0.0;  // Frobenius: |Ra − Rb|² = 8 sin²(angle / 2)
  for (int column = 0; column < 3; ++column) {
    const glm::dvec3 difference(a[column] - b[column]);
    squared += glm::dot(difference, difference);
  }
  return 2.0 * std::asin(std::min(1.0, std::sqrt(squared / 8.0)));
}

}  // namespace pleinair::tracking
