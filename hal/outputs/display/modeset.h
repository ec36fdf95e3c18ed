#pragma once

#include <vector>

#include "hal/outputs/display/card.h"
#include "hal/outputs/display/drift.h"
#include "hal/outputs/display/route.h"

namespace pleinair::hal::display {

/// What a commit has to change so that the route's display shows a framebuffer over its whole area:
/// the part of its mode's size at `offset`. `modeBlob`: of the mode's timings.
std::vector<Change> modesetChanges(const DisplayRoute& route, ObjectId modeBlob,
                                   ObjectId framebuffer, CanvasOffset offset = {});

/// The value of a plane's SRC_X and SRC_Y, in 1/65536 px.
constexpr std::uint64_t sourcePlace(int pixels) {
  return static_cast<std::uint64_t>(pixels) << 16U;
}

/// What switches the display off (DPMS).
std::vector<Change> switchOffChanges(const DisplayRoute& route);

}  // namespace pleinair::hal::display
