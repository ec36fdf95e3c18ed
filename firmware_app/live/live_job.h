#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "firmware_app/config/configuration.h"
#include "firmware_app/live/runtime_rules.h"
#include "firmware_app/offline/painting.h"
#include "firmware_app/status_server/status_server.h"
#include "hal/camera.h"
#include "hal/clock.h"
#include "hal/keyboards/keyboards.h"
#include "hal/supervisor/camera_selector.h"
#include "pipeline/scene/description/scene.h"

namespace pleinair::app {

/// The job of painting a camera's frames live.
struct LiveJob {
  hal::CameraSelector* selector = nullptr;
  hal::StreamRequest request;
  hal::Clock* clock = nullptr;
  PaintingOptions options;           ///< its output is ignored
  std::vector<std::string> outputs;  ///< targets, as of hal::openOutput(); at least one
  OutputOpener openOutput;
  RuntimeSettings runtime;
  std::optional<hal::KeyboardChoice> keyboards;  ///< whose keys do what a window's do
  /// Starts the status server; may return null.
  std::function<std::unique_ptr<StatusServer>(StatusPages)> serveStatus;
  bool waitsForCamera = false;   ///< at the start; after a loss it always waits
  bool waitsForOutputs = false;  ///< the same
  bool showsWaiting = true;      ///< on outputs of kinds that do (hal::OutputTraits)
  /// Where the last painting of such an output is kept, and was by the run before; empty: nowhere.
  std::filesystem::path state;
  scene::Scene scene;
  std::filesystem::path snapshots;  ///< the folder that snapshots go to
  std::filesystem::path frameLog;   ///< the file that FrameLogFile writes; empty: none
};

}  // namespace pleinair::app
