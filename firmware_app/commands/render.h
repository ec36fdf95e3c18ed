#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "hal/pixel_format.h"

namespace pleinair::app {

struct RenderOptions {
  std::filesystem::path input;
  std::filesystem::path output;
  std::string style = "watercolor";
  std::optional<std::filesystem::path> scene;
  std::optional<hal::FrameSize> size;   ///< default: the input's
  std::optional<std::uint64_t> frames;  ///< default: all
  std::string view;                     ///< empty: the finished picture
  std::vector<std::string> set;         ///< "name=value" of the style's parameters
  std::optional<std::filesystem::path> poses;
  std::optional<std::filesystem::path> contactSheet;
  std::filesystem::path shaderDirectory;
};

/// Paints a recording, frame by frame, none dropped: `pleinair render`. Throws hal::StartupError
/// and config::ConfigError. Returns the exit status: 0, or 128 + the signal that broke it off.
/// Then, or after a failure, nothing stands under the output's name, but a folder or a pattern
/// keeps the whole frames that were written so far.
int render(const RenderOptions& options);

}  // namespace pleinair::app
