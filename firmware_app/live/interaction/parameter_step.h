#pragma once

#include <optional>

#include "config/parameter.h"

namespace pleinair::app {

/// The next value of a parameter up (`direction` +1) or down (−1). Numbers move to the next
/// multiple of a step of 1, 2 or 5 times a power of ten, about a hundredth of their range; integers
/// move by 1. `large` multiplies the step by ten. Both stop at the ends of their range. Switches
/// toggle and choices wrap around. Unset if the value cannot change.
std::optional<config::ParameterValue> stepped(const config::ParameterDescriptor& descriptor,
                                              const config::ParameterValue& value, int direction,
                                              bool large);

}  // namespace pleinair::app
