#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>

#include "firmware_app/configuration.h"

namespace pleinair::app {

struct RecordOptions {
  ConfigurationRequest configuration;
  std::filesystem::path output;
  std::uint64_t frames = 150;
  std::optional<std::filesystem::path> writeScene;
};

/// Records [camera]'s camera to a movie or pictures, unpainted: `pleinair record`. Throws
/// hal::StartupError and config::ConfigError. Returns the exit status, as render() does.
int record(const RecordOptions& options);

}  // namespace pleinair::app
