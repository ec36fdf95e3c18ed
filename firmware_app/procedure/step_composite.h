#pragma once

#include <cstdint>
#include <vector>

#include "hal/image.h"

namespace pleinair::app {

/// What a pixel of a step's picture shows.
enum class StepPixel : std::uint8_t {
  kGround,      ///< nothing of the model
  kContext,     ///< other parts
  kFocus,       ///< a part in focus
  kTint,        ///< a tinted part
  kOutline,     ///< a part with an outline only
  kFocusHidden  ///< other parts before one in focus
};

/// Draws a step's picture from the shaded model: other parts pale, parts in focus in the colour
/// that is reserved for instructions with a dark line around, tinted ones half in it, outlined ones
/// with a line of it, and hatched where other parts hide them. `shaded` is RGB8, `pixels` row by
/// row; `ghosts`, empty or as many: where a ghost lies over it. Returns RGB8 of half the size, so
/// that edges are smooth. Precondition: an even size.
hal::Image stepComposite(const hal::Image& shaded, const std::vector<StepPixel>& pixels,
                         const std::vector<bool>& ghosts = {});

}  // namespace pleinair::app
