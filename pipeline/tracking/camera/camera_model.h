#pragma once

#include <array>
#include <optional>

#include <glm/mat2x2.hpp>
#include <glm/mat3x2.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "hal/pixel_format.h"

namespace pleinair::tracking {

/// A pinhole camera's focal lengths and principal point in pixels, pixel centres at +0.5.
struct Intrinsics {
  double fx = 1.0;
  double fy = 1.0;
  double cx = 0.0;
  double cy = 0.0;
};

/// Brown–Conrady lens distortion with OpenCV's terms in OpenCV's order: radial k1 k2, tangential p1
/// p2, radial k3, and the denominator k4 k5 k6 of the rational model. All zero: no distortion.
struct Distortion {
  double k1 = 0.0;
  double k2 = 0.0;
  double p1 = 0.0;
  double p2 = 0.0;
  double k3 = 0.0;
  double k4 = 0.0;
  double k5 = 0.0;
  double k6 = 0.0;
};

/// A projected point in pixels, and its derivative by the camera point (px per metre).
struct Projection {
  glm::dvec2 px{0.0};
  glm::dmat3x2 pxByCameraPoint{0.0};
};

/// Projects camera points into an image, and back. Camera frame: OpenCV's (x right, y down, z
/// forward), metres. Image: pixels from the top left corner, pixel centres at +0.5. A value type,
/// thread-safe.
class CameraModel {
 public:
  /// Precondition: fx, fy > 0 and isAcceptedSize(imageSize).
  CameraModel(Intrinsics intrinsics, Distortion distortion, hal::FrameSize imageSize);

  const Intrinsics& intrinsics() const { return intrinsics_; }
  const Distortion& distortion() const { return distortion_; }
  hal::FrameSize imageSize() const { return imageSize_; }

  /// Precondition: cameraPoint.z > 0.
  glm::dvec2 project(const glm::dvec3& cameraPoint) const;
  Projection projectWithJacobian(const glm::dvec3& cameraPoint) const;

  /// Returns the ray through a pixel as (x, y, 1), or nothing where the distortion has no inverse.
  /// A calibration that fits its lens has such pixels only outside of the image.
  std::optional<glm::dvec3> unproject(const glm::dvec2& px) const;

  /// Returns the model of the same camera whose image was scaled, then shifted: px' = scale · px +
  /// offset. A crop that starts at (x, y) has the offset (−x, −y).
  CameraModel resampled(const glm::dvec2& scale, const glm::dvec2& offset,
                        hal::FrameSize newSize) const;

 private:
  Intrinsics intrinsics_;
  Distortion distortion_;
  hal::FrameSize imageSize_;
};

}  // namespace pleinair::tracking
