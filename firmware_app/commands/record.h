#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "hal/pixel_format.h"

namespace pleinair::app {

struct RecordOptions {
  std::string camera = "synthetic";
  std::filesystem::path output;
  std::uint64_t frames = 150;
  hal::FrameSize size{640, 480};
  std::uint32_t seed = 1;
  std::optional<std::filesystem::path> writeScene;
};

/// Records a camera to a movie or pictures: `pleinair record`. Throws hal::StartupError. Returns
/// the exit status, as render() does.
int record(const RecordOptions& options);

}  // namespace pleinair::app
