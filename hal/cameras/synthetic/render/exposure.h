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

/// The exposure times of a frame's rows: all rows at once, or, with a rolling shutter, each row one
/// row time after the row above it. Time is continuous over the image: y = row + 0.5 has exactly
/// the time of that row.
class Exposure {
 public:
  /// Keeps a reference to `motion`. `start` is the time of row 0, counted from the first frame.
  Exposure(FrameSize size, const Motion& motion, Duration start, Duration rowTime);

  FrameSize size() const { return size_; }
  bool rolls() const { return rowTime_ != Duration::zero(); }
  double secondsAt(double y) const;
  CameraView viewAt(double y) const;
  BodyPoses bodiesAt(double y) const;

  /// The surface point visible at a pixel coordinate, if any.
  std::optional<SurfacePoint> visibleAt(const Geometry& geometry, glm::dvec2 pixel) const;
  /// Projects a surface point to the image, px, whether it is occluded or not. Nothing if the point
  /// is behind the camera or its body not in the scene, or if no row of a rolling shutter meets it
  /// near the image.
  std::optional<glm::dvec2> project(const SurfacePoint& point) const;

 private:
  FrameSize size_;
  PinholeIntrinsics intrinsics_;
  const Motion* motion_;
  double startSeconds_;
  double rowSeconds_;
  Duration rowTime_;
  CameraView startView_;  ///< at the time of row 0; with a global shutter, of every row
  BodyPoses startBodies_;
};

}  // namespace pleinair::hal::synthetic
