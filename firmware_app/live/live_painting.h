#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "firmware_app/config/configuration.h"
#include "firmware_app/offline/painting.h"
#include "firmware_app/status_server/status_server.h"
#include "hal/camera.h"
#include "hal/clock.h"
#include "hal/outputs/registry.h"
#include "hal/supervisor/camera_selector.h"
#include "pipeline/scene/description/scene.h"

namespace pleinair::app {

/// A camera's frames, painted as they come.
struct LiveJob {
  hal::CameraSelector* selector = nullptr;
  hal::StreamRequest request;
  hal::Clock* clock = nullptr;
  PaintingOptions options;           ///< its output is not looked at
  std::vector<std::string> outputs;  ///< as of hal::openOutput(); at least one
  hal::OutputOptionsByKind outputOptions;
  RuntimeSettings runtime;
  /// Begins to serve what is told of the painting; may give none.
  std::function<std::unique_ptr<StatusServer>(StatusPages)> serveStatus;
  bool waitsForCamera = false;  ///< at the start, where there is none; later it always does
  scene::Scene scene;
  std::filesystem::path snapshots;  ///< the folder that snapshots go to
};

/// Runs the job until its frames are shown, the recording ends, a window is closed, a key or a
/// signal says so; then prints the ledger on standard output and gives 0: ending it is no failure,
/// and a file has all that was written to it. A camera or a GPU that is lost, and an output that
/// can be opened again, are waited for. Throws hal::Failure and config::ConfigError; where an
/// output failed for good, after the ledger.
///
/// All ends within two seconds of a signal, which the caller's Interrupt takes: what does not (a
/// driver that hangs) is left behind, and the process ends here, with status 1, or 0 where nothing
/// had been painted yet.
int runLive(const LiveJob& job);

}  // namespace pleinair::app
