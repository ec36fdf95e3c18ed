#pragma once

#include <optional>
#include <string>

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

}  // namespace pleinair::measure
