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

/// Where a picture is drawn before it is turned about that place's centre by right angles, so that
/// it then fits the window as letterBox() says.
Area turnedLetterBox(FrameSize picture, FrameSize window, int quarterTurns);

/// The size that a window opens with: the picture's, a whole multiple of it if that is very small,
/// or the largest of its aspect ratio that fits `room`.
FrameSize openingSize(FrameSize picture, FrameSize room);

}  // namespace pleinair::hal::window
