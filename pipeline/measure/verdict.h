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
};

}  // namespace pleinair::measure
