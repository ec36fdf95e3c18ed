#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "pipeline/measure/anchor_measures.h"
#include "pipeline/measure/input/true_motion.h"
#include "pipeline/measure/measures.h"
#include "pipeline/measure/run_conditions.h"

namespace pleinair::measure {

/// How something that must read in a certain way does read.
struct Verdict {
  enum class State { kPassed, kFailed, kNotMeasured };

  std::string what;  ///< "nHW2 ≤ 0.3"
  State state = State::kNotMeasured;
  std::string found;  ///< "0.212", or why it was not measured

  /// What was compared, where that is one number with one limit.
  struct Comparison {
    std::optional<double> value;  ///< nothing where it was not measured
    std::optional<double> limit;  ///< nothing where what it hangs on was not measured
    bool isMost = true;           ///< the limit: else it is the least
  };
  std::optional<Comparison> comparison = {};
};

/// Whether a style has gates of its own.
bool hasGates(std::string_view style);

/// Those that have.
std::vector<std::string> gatedStyles();

/// What the gates of `style` say to an output's measures under these runConditions, whose motion
/// decides which of them are shut; `tiling` is what tiles fixed to the screen read on the same
/// frames. Precondition: hasGates(style).
std::vector<Verdict> gateVerdicts(std::string_view style, const RunConditions& runConditions,
                                  const Measures& measures, const Measures& tiling);

/// What they say to the style's anchors: under a pan, once two seconds are over, and on a still
/// scene. Empty for styles whose anchors have no gates.
std::vector<Verdict> anchorVerdicts(std::string_view style, MotionKind motion,
                                    const std::optional<AnchorSummary>& settled,
                                    const std::optional<AnchorSummary>& still);

}  // namespace pleinair::measure
