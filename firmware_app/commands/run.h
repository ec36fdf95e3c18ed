#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>

#include "firmware_app/configuration.h"

namespace pleinair::app {

struct RunOptions {
  ConfigurationRequest configuration;
  std::optional<std::uint64_t> frames;  ///< default: until someone ends it
  std::filesystem::path shaderDirectory;
};

/// Paints a camera live: `pleinair run`. Throws hal::StartupError and config::ConfigError. Returns
/// the exit status: 0, also where a signal ended it.
int run(const RunOptions& options);

}  // namespace pleinair::app
