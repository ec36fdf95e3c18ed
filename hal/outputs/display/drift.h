#pragma once

#include <cstdint>

namespace pleinair::hal::display {

/// A place on a canvas that is larger than the display, in pixels.
struct CanvasOffset {
  int x = 0;
  int y = 0;
  friend bool operator==(const CanvasOffset&, const CanvasOffset&) = default;
};

/// Which part of its canvas a display shows at a step of its drift, so that no edge of a picture
/// stays where it is and burns in: offsets of 0 to 2 × `pixels` in both directions. Step 0 shows
/// the middle. Each step is one pixel in one direction, and all (2 × `pixels` + 1)² offsets come
/// equally often, there and back.
CanvasOffset driftAt(std::uint64_t step, int pixels);

}  // namespace pleinair::hal::display
