#pragma once

#include <filesystem>
#include <string>

#include "firmware_app/painting.h"
#include "hal/camera.h"
#include "hal/clock.h"
#include "pipeline/scene/scene.h"

namespace pleinair::app {

/// A camera's frames, painted as they come.
struct LiveJob {
  hal::Camera* camera = nullptr;  ///< stopped; delivers in real time by `clock`
  hal::Clock* clock = nullptr;
  PaintingOptions options;
  scene::Scene scene;
  std::filesystem::path stills;  ///< the folder that stills go to
};

/// Runs the job until its frames are shown, the recording ends, a window is closed, a key or a
/// signal says so; then prints a summary on standard output and gives 0: ending it is no failure,
/// and a file has all that was painted. A newer frame takes the place of one that waits; what was
/// not shown is counted. Throws hal::StartupError and config::ConfigError, also for a camera that
/// is lost, then after the summary and with all in the file that was painted before.
int runLive(const LiveJob& job);

}  // namespace pleinair::app
