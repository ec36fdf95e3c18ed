#pragma once

#include <span>

#include "pipeline/scene/rig.h"

namespace pleinair::scene {

/// What `channel` says at `seconds`, into `value` (of Channel::width numbers; glTF 2.0, appendix
/// C). A rotation is x y z w, of unit length.
void valueAt(const Channel& channel, double seconds, std::span<double> value);

}  // namespace pleinair::scene
