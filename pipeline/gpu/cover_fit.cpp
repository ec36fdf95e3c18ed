#include "pipeline/gpu/cover_fit.h"

#include <algorithm>

namespace pleinair::gpu {

CoverFit coverFit(hal::FrameSize source, hal::FrameSize target) {
  const glm::dvec2 sourceSize(source.width, source.height);
  const glm::dvec2 targetSize(target.width, target.height);
  const double scale = std::min(sourceSize.x / targetSize.x, sourceSize.y / targetSize.y);
  return {.origin = 0.5 * (sourceSize - scale * targetSize), .scale = glm::dvec2(scale)};
}

}  // namespace pleinair::gpu
