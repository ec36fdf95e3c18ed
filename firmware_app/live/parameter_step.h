#pragma once

#include <optional>

#include "config/parameter.h"

namespace pleinair::app {

/// The next value of a parameter up (`direction` +1) or down (−1). Numbers go by 1, 2 or 5 times a
/// power of ten, about a hundredth of their range, to multiples of it; integers by 1; both by ten
/// times as much with `large`, and no further than their range. Switches turn over and choices go
/// round. Nothing where it stays as it is.
std::optional<config::ParameterValue> stepped(const config::ParameterDescriptor& descriptor,
                                              const config::ParameterValue& value, int direction,
                                              bool large);

}  // namespace pleinair::app
