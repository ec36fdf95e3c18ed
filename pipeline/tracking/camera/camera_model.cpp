#include "pipeline/tracking/camera/camera_model.h"

#include <cassert>
#include <cmath>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

namespace pleinair::tracking {
namespace {

constexpr int kMaxUndistortSteps = 30;
constexpr double kUndistortTolerance = 1e-12;  // distance on the normalised plane; squared below

struct Distorted {
  glm::dvec2 point{0.0};
  glm::dmat2 jacobian{1.0};  // columns: derivatives by x, by y
};

/// OpenCV's model (calib3d, "Detailed Description") on the plane z = 1.
Distorted distort(const Distortion& d, const glm::dvec2& p) {
  const double r2 = glm::dot(p, p);
  const double numerator = 1.0 + r2 * (d.k1 + r2 * (d.k2 + r2 * d.k3));
  const double denominator = 1.0 + r2 * (d.k4 + r2 * (d.k5 + r2 * d.k6));
  const double numeratorByR2 = d.k1 + r2 * (2.0 * d.k2 + r2 * 3.0 * d.k3);
  const double denominatorByR2 = d.k4 + r2 * (2.0 * d.k5 + r2 * 3.0 * d.k6);
  const double radial = numerator / denominator;
  const double radialByR2 = (numeratorByR2 - radial * denominatorByR2) / denominator;
  const double cross = 2.0 * p.x * p.y;

  Distorted out;
  out.point = p * radial + glm::dvec2(d.p1 * cross + d.p2 * (r2 + 2.0 * p.x * p.x),
                                      d.p1 * (r2 + 2.0 * p.y * p.y) + d.p2 * cross);
  out.jacobian[0] = {radial + 2.0 * p.x * p.x * radialByR2 + 2.0 * d.p1 * p.y + 6.0 * d.p2 * p.x,
                     cross * radialByR2 + 2.0 * d.p1 * p.x + 2.0 * d.p2 * p.y};
  out.jacobian[1] = {cross * radialByR2 + 2.0 * d.p1 * p.x + 2.0 * d.p2 * p.y,
                     radial + 2.0 * p.y * p.y * radialByR2 + 6.0 * d.p1 * p.y + 2.0 * d.p2 * p.x};
  return out;
}

}  // namespace

CameraModel::CameraModel(Intrinsics intrinsics, Distortion distortion, hal::FrameSize imageSize)
    : intrinsics_(intrinsics), distortion_(distortion), imageSize_(imageSize) {
  assert(intrinsics.fx > 0.0 && intrinsics.fy > 0.0);
  assert(hal::isAcceptedSize(imageSize));
}

glm::dvec2 CameraModel::project(const glm::dvec3& cameraPoint) const {
  const glm::dvec2 plane = glm::dvec2(cameraPoint) / cameraPoint.z;
  const glm::dvec2 distorted = distort(distortion_, plane).point;
  return {intrinsics_.fx * distorted.x + intrinsics_.cx,
          intrinsics_.fy * distorted.y + intrinsics_.cy};
}

Projection CameraModel::projectWithJacobian(const glm::dvec3& cameraPoint) const {
  const double inverseZ = 1.0 / cameraPoint.z;
  const glm::dvec2 plane = glm::dvec2(cameraPoint) * inverseZ;
  const Distorted distorted = distort(distortion_, plane);
  const glm::dvec2 focal(intrinsics_.fx, intrinsics_.fy);
  const glm::dmat3x2 planeByPoint(glm::dvec2(inverseZ, 0.0), glm::dvec2(0.0, inverseZ),
                                  -plane * inverseZ);
  const glm::dmat2 pxByPlane(focal * distorted.jacobian[0], focal * distorted.jacobian[1]);
  return {.px = focal * distorted.point + glm::dvec2(intrinsics_.cx, intrinsics_.cy),
          .pxByCameraPoint = pxByPlane * planeByPoint};
}

std::optional<glm::dvec3> CameraModel::unproject(const glm::dvec2& px) const {
  const glm::dvec2 wanted((px.x - intrinsics_.cx) / intrinsics_.fx,
                          (px.y - intrinsics_.cy) / intrinsics_.fy);
  glm::dvec2 plane = wanted;
  for (int step = 0; step < kMaxUndistortSteps; ++step) {
    const Distorted now = distort(distortion_, plane);
    const double determinant = glm::determinant(now.jacobian);
    if (!(determinant > 0.0)) return std::nullopt;  // the distortion folds over here, or NaN
    const glm::dvec2 error = now.point - wanted;
    if (glm::dot(error, error) < kUndistortTolerance * kUndistortTolerance) {
      return glm::dvec3(plane, 1.0);
    }
    plane -= glm::inverse(now.jacobian) * error;
  }
  return std::nullopt;
}

CameraModel CameraModel::resampled(const glm::dvec2& scale, const glm::dvec2& offset,
                                   hal::FrameSize newSize) const {
  const Intrinsics scaled{.fx = intrinsics_.fx * scale.x,
                          .fy = intrinsics_.fy * scale.y,
                          .cx = intrinsics_.cx * scale.x + offset.x,
                          .cy = intrinsics_.cy * scale.y + offset.y};
  return {scaled, distortion_, newSize};
}

}  // namespace pleinair::tracking
