#pragma once

#include <filesystem>

#include "firmware_app/configuration.h"
#include "firmware_app/painting.h"

namespace pleinair::app {

struct RenderOptions {
  ConfigurationRequest configuration;
  std::filesystem::path input;
  PaintingOptions painting;  ///< of one run alone; the rest is configuration
};

/// Paints a recording, frame by frame, none dropped: `pleinair render`. Throws hal::StartupError
/// and config::ConfigError. Returns the exit status: 0, or 128 + the signal that broke it off.
/// Then, or after a failure, nothing stands under the output's name, but a folder or a pattern
/// keeps the whole frames that were written so far.
int render(const RenderOptions& options);

}  // namespace pleinair::app
