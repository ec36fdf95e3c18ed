#pragma once

#include <optional>
#include <span>
#include <string>

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

}  // namespace pleinair::measure
