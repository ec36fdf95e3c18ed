#pragma once

#include <algorithm>
#include <chrono>
#include <cmath>

#include "hal/clock.h"

namespace pleinair::marks {

/// The time between two frames that counts for fades and means: 0 for a step backwards, at most a
/// second for a pause. Any thread.
inline hal::Duration timeStep(hal::TimePoint last, hal::TimePoint now) {
  return std::clamp<hal::Duration>(now - last, hal::Duration(0), std::chrono::seconds(1));
}

/// The share of the past's weight, in [0, 1], that remains in an exponential mean after `step`. 0
/// for a time constant of 0 or less. A step backwards counts as 0. Any thread.
inline float keptAfter(hal::Duration step, double timeConstantSeconds) {
  if (timeConstantSeconds <= 0.0) return 0.0F;
  const double seconds = std::max(0.0, std::chrono::duration<double>(step).count());
  return static_cast<float>(std::exp(-seconds / timeConstantSeconds));
}

}  // namespace pleinair::marks
