#pragma once

#include <cstdint>

#include <glm/mat3x3.hpp>
#include <glm/vec2.hpp>

#include "hal/image.h"

namespace pleinair::support {

/// A wall without end, with soft patches of all sizes from 5 px on: what is seen of it at any
/// place between pixels is known exactly.
double wallAt(const glm::dvec2& place, unsigned seed);

struct WallView {
  hal::FrameSize size{320, 240};
  /// From px of the frame, pixel centres at +0.5, to places on the wall.
  glm::dmat3 wallFromFrame{1.0};
  double noiseSigma = 0.0;  ///< of a pixel, grey levels
  unsigned noiseSeed = 1;
  unsigned wallSeed = 1;
  double contrast = 1.0;
  double brightness = 0.0;
};

/// The luma of a view.
hal::Image renderWall(const WallView& view);

/// Lays a view of another wall over a box (px) of a picture.
void layOver(hal::Image& image, const WallView& view, const glm::ivec2& from, const glm::ivec2& to);

/// Turn (rad) and zoom about the middle of a frame, then a shift (px), then a perspective bend:
/// what takes a place of the frame before to one of this.
struct PlaneStep {
  double turn = 0.0;
  double zoom = 1.0;
  glm::dvec2 shift{0.0};
  glm::dvec2 bend{0.0};  ///< by a px from the middle, per px
};
glm::dmat3 currentFromPrevious(const PlaneStep& step, hal::FrameSize size);

}  // namespace pleinair::support
