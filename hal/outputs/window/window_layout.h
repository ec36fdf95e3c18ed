#pragma once

#include "hal/pixel_format.h"

namespace pleinair::hal::window {

/// Pixels of a window, from its upper left corner.
struct Area {
  int x = 0;
  int y = 0;
  FrameSize size;
  friend bool operator==(const Area&, const Area&) = default;
};

/// Where a picture lies in a window: as large as fits in its own shape, centred, at least 1 px.
Area letterBox(FrameSize picture, FrameSize window);

/// What a window opens with: the picture's size, a whole multiple of it where it is very small, or
/// what fits `room` in its shape.
FrameSize openingSize(FrameSize picture, FrameSize room);

}  // namespace pleinair::hal::window
