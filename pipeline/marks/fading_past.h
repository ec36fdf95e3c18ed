#pragma once

#include <algorithm>
#include <chrono>
#include <cmath>

#include "hal/clock.h"

namespace pleinair::marks {

/// How much of the time between two frames counts for what fades and settles: none of a step
/// backwards, and a second of a longer pause. Any thread.
inline hal::Duration timeStep(hal::TimePoint last, hal::TimePoint now) {
  return std::clamp<hal::Duration>(now - last, hal::Duration(0), std::chrono::seconds(1));
}

/// What is left of the past's weight after `step` in an exponential mean with this time constant,
/// in [0, 1]: nothing where that is not above 0. A step backwards counts as none. Any thread.
inline float keptAfter(hal::Duration step, double timeConstantSeconds) {
  if (timeConstantSeconds <= 0.0) return 0.0F;
  const double seconds = std::max(0.0, std::chrono::duration<double>(step).count());
  return static_cast<float>(std::exp(-seconds / timeConstantSeconds));
}

}  // namespace pleinair::marks
