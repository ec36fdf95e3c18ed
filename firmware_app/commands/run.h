#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "firmware_app/painting.h"

namespace pleinair::app {

struct RunOptions : PaintingOptions {
  RunOptions() { output = "window"; }

  std::string camera = "synthetic";  ///< or the path of a recording
  std::optional<std::filesystem::path> scene;
  std::filesystem::path stills = ".";  ///< the folder that `s` saves to
};

/// Paints a camera live: `pleinair run`. Throws hal::StartupError and config::ConfigError. Returns
/// the exit status: 0, also where a signal ended it.
int run(const RunOptions& options);

}  // namespace pleinair::app
