#pragma once

#include <string_view>
#include <vector>

#include "pipeline/measure/measures.h"
#include "pipeline/measure/true_motion.h"
#include "pipeline/measure/verdict.h"

namespace pleinair::measure {

/// Whether a style has gates of its own.
bool hasGates(std::string_view style);

/// What the gates of `style` say to an output's measures on a motion of this kind; `tiling` is
/// what tiles fixed to the screen read on the same frames. Precondition: hasGates(style).
std::vector<Verdict> gateVerdicts(std::string_view style, MotionKind motion,
                                  const Measures& measures, const Measures& tiling);

}  // namespace pleinair::measure
