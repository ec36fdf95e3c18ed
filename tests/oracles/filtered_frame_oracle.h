#pragma once

#include <functional>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "hal/image.h"

namespace pleinair::oracles {

/// A plain CPU version of marks::FilteredFrame, for a camera image without objects. Row by row:
/// sRGB-coded colour, the number of frames in A.
struct FilteredFrameOracle {
  /// displacement (px), predicted error (px); a negative error: unknown.
  using Flow = std::function<glm::dvec3(glm::ivec2 block)>;

  /// Adds the next frame. `kept`: the remaining part of the past's weight; 0: no past. `noise`: σ.
  /// Blocks of 4×4 px have one displacement.
  void take(const hal::ImageView& frame, const Flow& flow, double kept, double noise);

  hal::FrameSize size;
  std::vector<glm::dvec4> picture;
};

}  // namespace pleinair::oracles
