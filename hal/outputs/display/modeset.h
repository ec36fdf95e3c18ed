#pragma once

#include <vector>

#include "hal/outputs/display/card.h"
#include "hal/outputs/display/route.h"

namespace pleinair::hal::display {

/// What a commit has to change so that the route's display shows a framebuffer of its mode's size
/// over its whole area. `modeBlob`: of the mode's timings.
std::vector<Change> modesetChanges(const DisplayRoute& route, ObjectId modeBlob,
                                   ObjectId framebuffer);

/// What switches the display off (DPMS).
std::vector<Change> switchOffChanges(const DisplayRoute& route);

}  // namespace pleinair::hal::display
