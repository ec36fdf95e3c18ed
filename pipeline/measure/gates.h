#pragma once

#include <optional>
#include <string>
#include <vector>

#include "pipeline/measure/anchor_measures.h"
#include "pipeline/measure/input/true_motion.h"
#include "pipeline/measure/measures.h"
#include "pipeline/measure/run_conditions.h"
#include "pipeline/styles/coherence_gates.h"

namespace pleinair::measure {

/// Whether a reading is within its limit.
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

/// The verdicts of a style's gates on an output's measures under these conditions, whose motion
/// decides which of them are judged; `tiling` is what tiles fixed to the screen read on the same
/// frames.
std::vector<Verdict> gateVerdicts(const styles::CoherenceGates& gates,
                                  const RunConditions& runConditions, const Measures& measures,
                                  const Measures& tiling);

/// The verdicts on the style's anchors: under a pan, once two seconds are over, and on a still
/// scene. Empty for styles that do not hold their anchors.
std::vector<Verdict> anchorVerdicts(const styles::CoherenceGates& gates, MotionKind motion,
                                    const std::optional<AnchorSummary>& settled,
                                    const std::optional<AnchorSummary>& still);

}  // namespace pleinair::measure
