#include "hal/cameras/synthetic/camera_view.h"

#include <algorithm>

#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>
#include <glm/vec4.hpp>

namespace pleinair::hal {

PinholeIntrinsics syntheticIntrinsics(FrameSize size) {
  const double focal = 0.9375 * std::max(size.width, size.height);
  return {.fx = focal, .fy = focal, .cx = size.width / 2.0, .cy = size.height / 2.0};
}

}  // namespace pleinair::hal

namespace pleinair::hal::synthetic {

glm::dvec3 CameraView::eye() const {
  return -(glm::transpose(glm::dmat3(cameraFromWorld)) * glm::dvec3(cameraFromWorld[3]));
}

std::optional<glm::dvec2> CameraView::project(glm::dvec3 world) const {
  constexpr double kNearestMetres = 1e-6;
  const glm::dvec3 p(cameraFromWorld * glm::dvec4(world, 1));
  if (p.z < kNearestMetres) return std::nullopt;
  return glm::dvec2(intrinsics.fx * p.x / p.z + intrinsics.cx,
                    intrinsics.fy * p.y / p.z + intrinsics.cy);
}

Ray CameraView::through(glm::dvec2 pixel) const {
  const glm::dmat3 worldFromCamera = glm::transpose(glm::dmat3(cameraFromWorld));
  const glm::dvec3 inCamera((pixel.x - intrinsics.cx) / intrinsics.fx,
                            (pixel.y - intrinsics.cy) / intrinsics.fy, 1);
  return {eye(), worldFromCamera * inCamera};
}

}  // namespace pleinair::hal::synthetic
