#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "pipeline/measure/anchor_measures.h"
#include "pipeline/measure/circumstances.h"
#include "pipeline/measure/measures.h"
#include "pipeline/measure/true_motion.h"
#include "pipeline/measure/verdict.h"

namespace pleinair::measure {

/// Whether a style has gates of its own.
bool hasGates(std::string_view style);

/// Those that have.
std::vector<std::string> gatedStyles();

/// What the gates of `style` say to an output's measures under these circumstances, whose motion
/// decides which of them are shut; `tiling` is what tiles fixed to the screen read on the same
/// frames. Precondition: hasGates(style).
std::vector<Verdict> gateVerdicts(std::string_view style, const Circumstances& circumstances,
                                  const Measures& measures, const Measures& tiling);

/// What they say to the style's anchors: under a pan, once two seconds are over, and on a still
/// scene. Empty for styles whose anchors have no gates.
std::vector<Verdict> anchorVerdicts(std::string_view style, MotionKind motion,
                                    const std::optional<AnchorSummary>& settled,
                                    const std::optional<AnchorSummary>& still);

}  // namespace pleinair::measure
