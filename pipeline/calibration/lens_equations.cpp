#include "pipeline/calibration/lens_equations.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

namespace pleinair::calibration {
namespace {

constexpr double kMinDepthMetres = 1e-6;
constexpr double kMinFocalPx = 1.0;
constexpr double kMaxFocalPx = 1e6;

bool isSound(const LensVec& lens) {
  const auto isFocal = [](double f) { return f > kMinFocalPx && f < kMaxFocalPx; };
  return isFocal(lens[0]) && isFocal(lens[1]) &&
         std::ranges::all_of(lens.val, [](double value) { return std::isfinite(value); });
}

}  // namespace

tracking::CameraModel cameraOf(const LensVec& lens, hal::FrameSize size) {
  return {{.fx = lens[0], .fy = lens[1], .cx = lens[2], .cy = lens[3]},
          {.k1 = lens[4], .k2 = lens[5], .p1 = lens[6], .p2 = lens[7], .k3 = lens[8]},
          size};
}

cv::Matx<double, 2, kLensParameters> lensJacobian(const LensVec& lens, const glm::dvec2& plane,
                                                  LensModel model) {
  const double x = plane.x;
  const double y = plane.y;
  const double r2 = x * x + y * y;
  const double radial = 1.0 + r2 * (lens[4] + r2 * (lens[5] + r2 * lens[8]));
  const double bentX = x * radial + 2.0 * lens[6] * x * y + lens[7] * (r2 + 2.0 * x * x);
  const double bentY = y * radial + lens[6] * (r2 + 2.0 * y * y) + 2.0 * lens[7] * x * y;
  const double fx = lens[0];
  const double fy = lens[1];
  cv::Matx<double, 2, kLensParameters> by{bentX,
                                          0.0,
                                          1.0,
                                          0.0,
                                          fx * x * r2,
                                          fx * x * r2 * r2,
                                          fx * 2.0 * x * y,
                                          fx * (r2 + 2.0 * x * x),
                                          fx * x * r2 * r2 * r2,
                                          0.0,
                                          bentY,
                                          0.0,
                                          1.0,
                                          fy * y * r2,
                                          fy * y * r2 * r2,
                                          fy * (r2 + 2.0 * y * y),
                                          fy * 2.0 * x * y,
                                          fy * y * r2 * r2 * r2};
  const auto hold = [&](int parameter) { by(0, parameter) = by(1, parameter) = 0.0; };
  if (model < LensModel::kK1) hold(4);
  if (model < LensModel::kK1K2) hold(5);
  if (model < LensModel::kK1K2P) hold(6);
  if (model < LensModel::kK1K2P) hold(7);
  if (model < LensModel::kK1K2PK3) hold(8);
  return by;
}

ViewEquations viewEquations(const tracking::CameraModel& camera, LensModel model,
                            const FitView& view, const glm::dmat4& cameraFromBoard,
                            double huberPx) {
  const LensVector parameters = parametersOf(camera);
  const LensVec lens(parameters.data());
  const glm::dmat3 rotation(cameraFromBoard);
  const glm::dvec3 translation(cameraFromBoard[3]);
  ViewEquations sum{};
  for (const tracking::Correspondence& point : view) {
    const glm::dvec3 arm = rotation * point.target;
    const glm::dvec3 seen = arm + translation;
    const tracking::Projection projection = camera.projectWithJacobian(seen);
    const glm::dvec2 residual = point.px - projection.px;
    const double distance = glm::length(residual);
    const double weight = distance > huberPx ? huberPx / distance : 1.0;
    const auto byLens = lensJacobian(lens, glm::dvec2(seen) / seen.z, model);
    const glm::dmat3x2& byPoint = projection.pxByCameraPoint;
    cv::Matx<double, 2, 6> byPose;  // rotation about the board's origin, then translation
    for (int axis = 0; axis < 3; ++axis) {
      glm::dvec3 unit(0.0);
      unit[axis] = 1.0;
      const glm::dvec2 turned = byPoint * glm::cross(unit, arm);
      byPose(0, axis) = turned.x;
      byPose(1, axis) = turned.y;
      byPose(0, axis + 3) = byPoint[axis].x;
      byPose(1, axis + 3) = byPoint[axis].y;
    }
    const cv::Vec2d r(residual.x, residual.y);
    sum.lens += weight * (byLens.t() * byLens);
    sum.mixed += weight * (byLens.t() * byPose);
    sum.pose += weight * (byPose.t() * byPose);
    sum.lensScore += weight * (byLens.t() * r);
    sum.poseScore += weight * (byPose.t() * r);
  }
  return sum;
}

double lensCost(const LensState& state, std::span<const FitView> views, hal::FrameSize size,
                double huberPx) {
  constexpr double kImpossible = std::numeric_limits<double>::infinity();
  if (!isSound(state.lens)) return kImpossible;
  const tracking::CameraModel camera = cameraOf(state.lens, size);
  double cost = 0.0;
  for (std::size_t v = 0; v < views.size(); ++v) {
    for (const tracking::Correspondence& point : views[v]) {
      const glm::dvec3 seen(state.cameraFromBoard[v] * glm::dvec4(point.target, 1.0));
      if (!(seen.z > kMinDepthMetres)) return kImpossible;
      const double distance = glm::distance(camera.project(seen), point.px);
      cost += distance <= huberPx ? distance * distance : huberPx * (2.0 * distance - huberPx);
    }
  }
  if (!std::isfinite(cost)) return kImpossible;
  return cost;
}

}  // namespace pleinair::calibration
