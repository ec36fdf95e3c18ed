#include "pipeline/scene/description/scene.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "pipeline/gpu/images/aspect_fill.h"

namespace pleinair::scene {

const tracking::TagMarker* Scene::findTag(int id) const {
  const auto found = std::ranges::find(tags, id, &tracking::TagMarker::id);
  return found == tags.end() ? nullptr : &*found;
}

tracking::CameraModel assumedCamera(hal::FrameSize size) {
  constexpr double kHalfFieldRad = std::numbers::pi / 6.0;
  const double focal = 0.5 * size.width / std::tan(kHalfFieldRad);
  return {{.fx = focal, .fy = focal, .cx = 0.5 * size.width, .cy = 0.5 * size.height}, {}, size};
}

tracking::CameraModel fittedCamera(const tracking::CameraModel& camera,
                                   hal::FrameSize pictureSize) {
  const gpu::AspectFill fit = gpu::aspectFill(camera.imageSize(), pictureSize);
  return camera.resampled(1.0 / fit.scale, -fit.origin / fit.scale, pictureSize);
}

}  // namespace pleinair::scene
