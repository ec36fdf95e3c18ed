#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "hal/camera.h"
#include "hal/clock.h"

namespace pleinair::app {

/// A recording of what a camera does (hal/captures/capture_writer.h).
struct CaptureJob {
  hal::Camera* camera = nullptr;  ///< stopped
  hal::StreamRequest request;
  std::string requestText;            ///< for people
  const hal::Clock* clock = nullptr;  ///< the camera's
  std::filesystem::path output;       ///< .mkv
  std::uint64_t frames = 0;           ///< at most
};

/// Records until the frames are there, the camera ends or is lost, its format changes, or a signal
/// comes; the frames so far are completed and kept. Gives the exit status. Throws hal::Failure,
/// that of the camera at the end.
int runCapture(const CaptureJob& job);

}  // namespace pleinair::app
