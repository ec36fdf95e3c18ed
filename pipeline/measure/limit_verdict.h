#pragma once

#include <optional>

#include "pipeline/measure/gates.h"

namespace pleinair::measure {

/// A fixed limit of one number.
struct Limit {
  const char* name;
  const char* unit;
  double value;
  const char* missing;  ///< why there may be nothing to compare
  bool isUpper = true;
  bool isReached = false;  ///< of a lower limit: whether equality passes
};

Verdict verdictOf(const Limit& limit, std::optional<double> value);

/// Half of an upper limit is left to the painting: a motion along which the input itself reads more
/// says nothing about the marks.
Verdict verdictAlong(const Limit& limit, std::optional<double> value,
                     std::optional<double> ofInput);

}  // namespace pleinair::measure
