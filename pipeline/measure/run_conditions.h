#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "pipeline/measure/input/measured_input.h"
#include "pipeline/measure/measures.h"

namespace pleinair::measure {

/// The conditions of a measurement; they decide which measures are available.
struct RunConditions {
  MotionKind motion = MotionKind::kNone;
  std::uint64_t frames = 0;       ///< measured
  std::uint64_t stillFrames = 0;  ///< of the still scene
  double stillNoiseLevels = 0;
};

/// Reason why a measure is unavailable: "it compares frames 10 apart, and there are 4".
std::string reasonMissing(std::optional<double> Measures::*measure,
                          const RunConditions& runConditions);

/// One line for each such reason: "S10 %, SCR: it compares …".
std::vector<std::string> missingLines(const Measures& measures, const RunConditions& runConditions);

}  // namespace pleinair::measure
