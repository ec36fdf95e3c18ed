#pragma once

#include <optional>

#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "hal/cameras/synthetic/render/motion.h"
#include "hal/cameras/synthetic/world/geometry.h"
#include "hal/clock.h"
#include "hal/pixel_format.h"

namespace pleinair::hal::synthetic {

/// How a frame is taken: all rows at once, or, with a rolling shutter, each a row time after the
/// one above it. The moment is continuous over the picture, so that it is a row's own at the
/// row's middle: y = row + 0.5.
class Exposure {
 public:
  /// Keeps a reference to `motion`. `start` is the time of row 0 since the first frame's.
  Exposure(FrameSize size, const Motion& motion, Duration start, Duration rowTime);

  FrameSize size() const { return size_; }
  bool rolls() const { return rowTime_ != Duration::zero(); }
  double secondsAt(double y) const;
  CameraView viewAt(double y) const;
  glm::dmat4 worldFromMoverAt(double y) const;

  /// What is seen at a pixel coordinate; nothing where there is nothing.
  std::optional<SurfacePoint> seenAt(const Geometry& geometry, glm::dvec2 pixel) const;
  /// Where a point of a surface appears, px, hidden or not; nothing where it is behind the camera,
  /// or where a rolling shutter's rows never meet it within reach of the picture.
  std::optional<glm::dvec2> project(const SurfacePoint& point) const;

 private:
  FrameSize size_;
  PinholeIntrinsics intrinsics_;
  const Motion* motion_;
  double startSeconds_;
  double rowSeconds_;
  Duration rowTime_;
};

}  // namespace pleinair::hal::synthetic
