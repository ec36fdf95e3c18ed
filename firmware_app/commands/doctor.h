#pragma once

#include "firmware_app/configuration.h"

namespace pleinair::app {

struct DoctorOptions {
  ConfigurationRequest configuration;
  bool json = false;
};

/// Prints what works on this machine, what does not, and what mends it: `pleinair doctor`. Gives 0
/// where nothing is wrong, warnings or not, else 1.
int examineMachine(const DoctorOptions& options);

}  // namespace pleinair::app
