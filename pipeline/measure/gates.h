#pragma once

#include <optional>
#include <string>
#include <vector>

#include "pipeline/measure/anchor_measures.h"
#include "pipeline/measure/input/true_motion.h"
#include "pipeline/measure/measures.h"
#include "pipeline/styles/coherence_gates.h"

namespace pleinair::measure {

/// The result of comparing a measure with its limit.
struct Verdict {
  enum class State { kPassed, kFailed, kNotMeasured };

  std::string what;  ///< "nHW2 ≤ 0.3"
  State state = State::kNotMeasured;
  std::string found;  ///< "0.212", or the reason why it was not measured

  /// The numbers that were compared, if it is one number with one limit.
  struct Comparison {
    std::optional<double> value;  ///< nothing if it was not measured
    std::optional<double> limit;  ///< nothing if the limit's reference was not measured
    bool isUpperLimit = true;     ///< true: `limit` is an upper limit; false: a lower one
  };
  std::optional<Comparison> comparison = {};
};

/// Evaluates a style's gates for an output's measures under these conditions, whose motion decides
/// which gates apply. `tiling`: measures of tiles fixed to the screen on the same frames.
std::vector<Verdict> gateVerdicts(const styles::CoherenceGates& gates,
                                  const RunConditions& runConditions, const Measures& measures,
                                  const Measures& tiling);

/// Evaluates the gates on the style's anchors: under a pan, after the first two seconds, and on a
/// still scene. Empty for styles without such gates.
std::vector<Verdict> anchorVerdicts(const styles::CoherenceGates& gates, MotionKind motion,
                                    const std::optional<AnchorSummary>& settled,
                                    const std::optional<AnchorSummary>& still);

}  // namespace pleinair::measure
