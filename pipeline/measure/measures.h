#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "pipeline/measure/input/true_motion.h"

namespace pleinair::measure {

/// The measures of one output, named as in docs/measuring.md; empty where one is unavailable.
struct Measures {
  std::optional<double> ew2, xEw2, nHw2, popPercent, s10Percent, scr, xFlk, dep, det;
};

/// Description of a measure in tables.
struct MeasureColumn {
  std::optional<double> Measures::*value;
  const char* name;    ///< "nHW2"
  const char* key;     ///< in JSON: "nhw2"
  const char* format;  ///< for fmt: "{:.3f}"
  const char* unit;    ///< along an axis: "levels"
  const char* reads;   ///< meaning of its values
};

/// All columns, in the order of reports.
std::span<const MeasureColumn> measureColumns();

/// "0.123", or "–" where it is unavailable.
std::string textOf(const MeasureColumn& column, const Measures& measures);

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
