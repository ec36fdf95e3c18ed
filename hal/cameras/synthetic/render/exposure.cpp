#include "hal/cameras/synthetic/render/exposure.h"

#include <cmath>

namespace pleinair::hal::synthetic {
Exposure::Exposure(FrameSize size, const Motion& motion, Duration start, Duration rowTime)
    : size_(size),
      intrinsics_(syntheticIntrinsics(size)),
      motion_(&motion),
      startSeconds_(toSeconds(start)),
      rowSeconds_(toSeconds(rowTime)),
      rowTime_(rowTime) {}

double Exposure::secondsAt(double y) const {
  return startSeconds_ + (y - 0.5) * rowSeconds_;
}

CameraView Exposure::viewAt(double y) const {
  const double time = rolls() ? secondsAt(y) : startSeconds_;
  return {intrinsics_, motion_->cameraFromWorld(time)};
}

glm::dmat4 Exposure::worldFromMoverAt(double y) const {
  return motion_->worldFromMover(rolls() ? secondsAt(y) : startSeconds_);
}

std::optional<SurfacePoint> Exposure::visibleAt(const Geometry& geometry, glm::dvec2 pixel) const {
  return geometry.firstAlong(viewAt(pixel.y).through(pixel), worldFromMoverAt(pixel.y));
}

std::optional<glm::dvec2> Exposure::project(const SurfacePoint& point) const {
  constexpr int kMaxSteps = 60;
  constexpr double kSettledPx = 1e-10;
  double y = size_.height / 2.0;
  for (int step = 0; step < kMaxSteps; ++step) {
    const auto at = viewAt(y).project(inWorld(point, worldFromMoverAt(y)));
    if (!at || !rolls()) return at;
    // Rows far outside the image are not exposed: their times are clamped near the frame's own.
    const double next = std::fmin(std::fmax(at->y, -1.0 * size_.height), 2.0 * size_.height);
    if (std::abs(next - y) < kSettledPx) return at;
    y = next;
  }
  return std::nullopt;
}

}  // namespace pleinair::hal::synthetic
