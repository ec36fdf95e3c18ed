#pragma once

#include <chrono>
#include <optional>

#include "hal/clock.h"

namespace pleinair::hal {

/// Whether a machine's clock may be right: no machine has run this program before 2026. One without
/// a battery begins in 1970, or where it was switched off.
bool isPlausible(std::chrono::system_clock::time_point time);

/// Local time, since midnight; nothing while the machine's clock cannot be right, so that nothing
/// is switched by it. Any thread.
std::optional<Duration> localTimeOfDay();

}  // namespace pleinair::hal
