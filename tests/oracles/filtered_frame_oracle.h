#pragma once

#include <functional>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "hal/image.h"

namespace pleinair::oracles {

/// marks::FilteredFrame on the CPU, as plainly as it can be said, for a camera's picture without
/// objects. Row by row: sRGB-coded colour, frames' worth of it in A.
struct FilteredFrameOracle {
  /// displacement (px), predicted error (px); a negative error: nothing is known.
  using Flow = std::function<glm::dvec3(glm::ivec2 block)>;

  /// The next frame. `kept`: the part of the past's weight that is left; 0: none. `noise`: σ.
  /// Blocks of 4×4 px move as one.
  void take(const hal::ImageView& frame, const Flow& flow, double kept, double noise);

  hal::FrameSize size;
  std::vector<glm::dvec4> picture;
};

}  // namespace pleinair::oracles
