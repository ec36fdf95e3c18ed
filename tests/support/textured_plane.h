#pragma once

#include <cstdint>

#include <glm/mat3x3.hpp>
#include <glm/vec2.hpp>

#include "hal/image.h"

namespace pleinair::support {

/// An endless wall with soft patches of all sizes from 5 px on. Its value is known exactly at any
/// place between pixels.
double wallAt(const glm::dvec2& place, unsigned seed);

struct WallView {
  hal::FrameSize size{320, 240};
  /// Maps px of the frame, pixel centres at +0.5, to places on the wall.
  glm::dmat3 wallFromFrame{1.0};
  double noiseSigma = 0.0;  ///< per pixel, in grey levels
  unsigned noiseSeed = 1;
  unsigned wallSeed = 1;
  double contrast = 1.0;
  double brightness = 0.0;
};

/// Renders the luma of a view.
hal::Image renderWall(const WallView& view);

/// Renders a view of another wall into a box (px) of an image.
void overlayWall(hal::Image& image, const WallView& view, const glm::ivec2& from,
                 const glm::ivec2& to);

/// Maps a place of the previous frame to one of this frame: rotation (rad) and zoom about the
/// middle of the frame, then a shift (px), then a perspective distortion.
struct PlaneStep {
  double turn = 0.0;
  double zoom = 1.0;
  glm::dvec2 shift{0.0};
  glm::dvec2 bend{0.0};  ///< per px from the middle
};
glm::dmat3 currentFromPrevious(const PlaneStep& step, hal::FrameSize size);

}  // namespace pleinair::support
