#pragma once

#include <vector>

#include "pipeline/overlay/overlay_content.h"
#include "pipeline/procedure/procedure.h"
#include "pipeline/scene/models/model.h"

namespace pleinair::app {

/// The ghosts of a step: parts that it shows as such, those of its exploded view, and, where it has
/// none, the parts that it moves, on their way. `unitMetres`: Procedure::unitMetres.
std::vector<overlay::Ghost> ghostsOf(const procedure::Step& step, const scene::Model& machine,
                                     double unitMetres);

/// Whether a ghost stands still: a picture can show it.
bool isStill(const overlay::Ghost& ghost);

}  // namespace pleinair::app
