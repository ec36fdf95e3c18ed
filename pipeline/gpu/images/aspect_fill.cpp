#include "pipeline/gpu/images/aspect_fill.h"

#include <algorithm>

#include <glm/common.hpp>

namespace pleinair::gpu {

AspectFill aspectFill(hal::FrameSize source, hal::FrameSize target) {
  const glm::dvec2 sourceSize(source.width, source.height);
  const glm::dvec2 targetSize(target.width, target.height);
  const double scale = std::min(sourceSize.x / targetSize.x, sourceSize.y / targetSize.y);
  return {.origin = 0.5 * (sourceSize - scale * targetSize), .scale = glm::dvec2(scale)};
}

bool AspectFill::isIdentity() const {
  constexpr double kRounding = 1e-9;
  const glm::dvec2 off = glm::abs(origin) + glm::abs(scale - 1.0);
  return std::max(off.x, off.y) < kRounding;
}

}  // namespace pleinair::gpu
