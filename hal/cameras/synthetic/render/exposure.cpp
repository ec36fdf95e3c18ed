#include "hal/cameras/synthetic/render/exposure.h"

#include <cmath>

namespace pleinair::hal::synthetic {
Exposure::Exposure(FrameSize size, const Motion& motion, Duration start, Duration rowTime)
    : size_(size),
      intrinsics_(syntheticIntrinsics(size)),
      motion_(&motion),
      startSeconds_(toSeconds(start)),
      rowSeconds_(toSeconds(rowTime)),
      rowTime_(rowTime),
      startView_{intrinsics_, motion.cameraFromWorld(startSeconds_)},
      startBodies_(motion.bodies(startSeconds_)) {}

double Exposure::secondsAt(double y) const {
  return startSeconds_ + (y - 0.5) * rowSeconds_;
}

CameraView Exposure::viewAt(double y) const {
  if (!rolls()) return startView_;
  return {intrinsics_, motion_->cameraFromWorld(secondsAt(y))};
}

BodyPoses Exposure::bodiesAt(double y) const {
  return rolls() ? motion_->bodies(secondsAt(y)) : startBodies_;
}

std::optional<SurfacePoint> Exposure::visibleAt(const Geometry& geometry, glm::dvec2 pixel) const {
  if (!rolls()) return geometry.firstAlong(startView_.through(pixel), startBodies_);
  return geometry.firstAlong(viewAt(pixel.y).through(pixel), bodiesAt(pixel.y));
}

std::optional<glm::dvec2> Exposure::project(const SurfacePoint& point) const {
  constexpr int kMaxSteps = 60;
  constexpr double kSettledPx = 1e-10;
  if (!startBodies_.has(point.body)) return std::nullopt;
  if (!rolls()) return startView_.project(inWorld(point, startBodies_[point.body]));
  double y = size_.height / 2.0;
  for (int step = 0; step < kMaxSteps; ++step) {
    const glm::dvec3 world =
        point.body == kRoom ? point.point : inWorld(point, bodiesAt(y)[point.body]);
    const auto at = viewAt(y).project(world);
    if (!at) return at;
    // Rows far outside the image are not exposed: their times are clamped near the frame's own.
    const double next = std::fmin(std::fmax(at->y, -1.0 * size_.height), 2.0 * size_.height);
    if (std::abs(next - y) < kSettledPx) return at;
    y = next;
  }
  return std::nullopt;
}

}  // namespace pleinair::hal::synthetic
