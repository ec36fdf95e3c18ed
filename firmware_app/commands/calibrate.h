#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>

#include "firmware_app/board_option.h"
#include "firmware_app/configuration.h"

namespace pleinair::app {

struct CalibrateOptions {
  ConfigurationRequest configuration;
  BoardOption board;
  std::optional<std::filesystem::path> input;  ///< a recording; else [camera]'s camera
  std::filesystem::path output;
  std::optional<std::uint64_t> frames;
  std::optional<std::filesystem::path> viewsFolder;
};

/// Finds a camera's lens from views of a board: `pleinair calibrate`. A recording is looked at
/// frame by frame; a camera until the views suffice, --frames are over or a signal comes, which
/// then uses what there is. Throws hal::StartupError, for a calibration that is not to be trusted
/// too, and config::ConfigError. Returns the exit status: 0, or 128 + the signal that broke off a
/// recording. The output is written whole or not at all; a calibration that stood there is
/// replaced, and said so; any other file is refused.
int calibrate(const CalibrateOptions& options);

}  // namespace pleinair::app
