#pragma once

#include <optional>
#include <span>
#include <string>

namespace pleinair::measure {

/// The measures of one output, named as docs/measuring.md has them; nothing where one could not be
/// had.
struct Measures {
  std::optional<double> ew2, xEw2, nHw2, popPercent, s10Percent, scr, xFlk, dep, det;
};

/// What a table says of a measure.
struct MeasureColumn {
  std::optional<double> Measures::*value;
  const char* name;    ///< "nHW2"
  const char* key;     ///< of JSON: "nhw2"
  const char* format;  ///< of fmt: "{:.3f}"
  const char* unit;    ///< along an axis: "levels"
  const char* reads;   ///< what its values mean
};

/// All, in the order in which they are told.
std::span<const MeasureColumn> measureColumns();

/// "0.123", or "–" where it could not be had.
std::string textOf(const MeasureColumn& column, const Measures& measures);

}  // namespace pleinair::measure
