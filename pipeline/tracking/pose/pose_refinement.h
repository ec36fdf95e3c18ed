#pragma once

#include <array>
#include <limits>
#include <optional>
#include <span>

#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "pipeline/tracking/camera/camera_model.h"

namespace pleinair::tracking {

/// A point of the target (a tag or the world; metres) and its position in the image (pixels).
struct Correspondence {
  glm::dvec3 target;
  glm::dvec2 px;
  /// Scales an error to px of a plain point's noise: less than one in a direction in which the
  /// point is less certain.
  glm::dmat2 whitening{1.0};
};

/// Row-major 6 × 6 covariance of a small motion of the target in camera axes: rotation about the
/// target's origin (rad), then translation (m).
using PoseCovariance = std::array<double, 36>;

/// A pose and its errors.
struct PoseEstimate {
  glm::dmat4 cameraFromTarget{1.0};
  /// Root mean square reprojection error, in pixels.
  double rmsPx = 0.0;
  PoseCovariance covariance{};  ///< from the points' whitened residuals; at least 0.1 px is assumed

  /// Predicted standard deviations over all axes.
  double rotationSigmaRad() const;
  double translationSigmaMetres() const;
};

/// Minimises the reprojection error from a start (Levenberg–Marquardt; beyond `huberPx` an error
/// counts linearly, Huber 1964). Returns nothing where the start shows a point behind the camera or
/// the points do not determine a pose. Errors are whitened; rmsPx is not.
std::optional<PoseEstimate> refinePose(const CameraModel& camera,
                                       std::span<const Correspondence> points,
                                       const glm::dmat4& startCameraFromTarget,
                                       double huberPx = std::numeric_limits<double>::infinity());

/// Sum of squared reprojection distances (px²); infinite where a point is behind the camera.
double squaredErrorPx(const CameraModel& camera, std::span<const Correspondence> points,
                      const glm::dmat4& cameraFromTarget);

/// Transforms a point of the target into camera axes.
inline glm::dvec3 transform(const glm::dmat4& cameraFromTarget, const glm::dvec3& target) {
  return glm::dvec3(cameraFromTarget * glm::dvec4(target, 1.0));
}

/// The angle between two poses' rotations.
double rotationBetweenRad(const glm::dmat4& a, const glm::dmat4& b);

}  // namespace pleinair::tracking
