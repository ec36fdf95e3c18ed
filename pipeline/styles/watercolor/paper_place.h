#pragma once

#include <glm/vec2.hpp>

#include "pipeline/scene/ar_frame.h"

namespace pleinair::styles {

inline constexpr int kPaperPixels = 512;  ///< a side of the sheet's tile, as in paper.frag

/// Where a pixel lies on the paper, which goes with the picture as a whole. The paper keeps its
/// grain's size on the screen under any zoom: two octaves of it blend into each other.
struct PaperPlace {
  glm::vec2 linear;  // of the finer octave: complex, paper px a picture px
  glm::vec2 shift;   // paper px
  float coarser;     // how much of the coarser octave is seen
};
PaperPlace paperPlace(const scene::ArFrame& frame);

}  // namespace pleinair::styles
