#pragma once

#include <optional>
#include <string>

#include "hal/error.h"
#include "hal/pixel_format.h"

namespace pleinair::hal::display {

/// How pictures lie on a display.
struct Placement {
  enum class Fit {
    kLetterbox,  ///< whole, with black bars
    kFill,       ///< over all of it, the overhang cut off
  };
  Fit fit = Fit::kLetterbox;
  int quarterTurns = 0;  ///< of the picture, clockwise
  /// Of each side of the display that stays black on each edge, for screens that hide theirs, in
  /// percent.
  double marginPercent = 0.0;
};

/// Pixels of a display, from its upper left corner.
struct PictureArea {
  int x = 0;
  int y = 0;
  FrameSize size;
  friend bool operator==(const PictureArea&, const PictureArea&) = default;
};

/// Where a picture of this size (before it is turned) lies. At least 1 px a side.
PictureArea areaOf(FrameSize picture, FrameSize display, const Placement& placement);

}  // namespace pleinair::hal::display
