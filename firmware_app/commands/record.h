#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "hal/pixel_format.h"

namespace pleinair::app {

struct RecordOptions {
  std::string camera = "synthetic";  ///< or "synthetic:SHOT"
  std::filesystem::path output;
  std::uint64_t frames = 150;
  hal::FrameSize size{640, 480};
  std::uint32_t seed = 1;
  double framesPerSecond = 30;
  double noiseSigma = 2;  ///< 8-bit levels
  double exposureDriftStops = 0;
  double whiteBalanceDrift = 0;  ///< a share
  double readoutMilliseconds =
      0;  ///< from the first row's exposure to the last's; 0: global shutter
  std::optional<std::filesystem::path> writeScene;
};

/// Records a camera to a movie or pictures: `pleinair record`. Throws hal::StartupError. Returns
/// the exit status, as render() does.
int record(const RecordOptions& options);

}  // namespace pleinair::app
