#pragma once

#include <string>

#include "hal/clock.h"

namespace pleinair::hal {

/// For a person: "310 ms" below a second, else "3.3 s".
std::string durationText(Duration duration);

}  // namespace pleinair::hal
