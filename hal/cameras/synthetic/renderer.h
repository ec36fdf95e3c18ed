#pragma once

#include <cstdint>
#include <memory>
#include <span>

#include <glm/vec3.hpp>

#include "hal/cameras/synthetic/camera_view.h"
#include "hal/cameras/synthetic/desk_painting.h"

namespace pleinair::hal::synthetic {

/// Looks at the desk: for each pixel the point of the plane under it, by the inverse homography,
/// sampled from the two nearest mip levels at two points along the footprint's longer side, so that
/// slanted edges are neither blurred nor shimmer. Immutable; thread-safe.
class Renderer {
 public:
  explicit Renderer(std::shared_ptr<const DeskPicture> desk);

  /// Pixels of row `y` from column `x` on, in linear light. The footprint is that of the run's
  /// middle, so keep runs short.
  void renderRun(const CameraView& view, int x, int y, std::span<glm::vec3> linearRgb) const;

 private:
  std::shared_ptr<const DeskPicture> desk_;
};

}  // namespace pleinair::hal::synthetic
