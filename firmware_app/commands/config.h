#pragma once

#include "firmware_app/configuration.h"

namespace pleinair::app {

struct ConfigOptions {
  ConfigurationRequest configuration;
  bool givenOnly = false;  ///< leave out what nobody gave
};

/// Prints what is in force, where each value came from and what is allowed, as TOML: `pleinair
/// config`. Throws config::ConfigError. Returns the exit status.
int printConfiguration(const ConfigOptions& options);

}  // namespace pleinair::app
