#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "config/parameter_values.h"
#include "firmware_app/config/configuration.h"
#include "firmware_app/config/input_map.h"
#include "firmware_app/config/reload.h"
#include "firmware_app/live/runtime_rules.h"
#include "firmware_app/offline/painting.h"
#include "firmware_app/repair_station/live_procedure.h"
#include "firmware_app/repair_station/step_inputs.h"
#include "firmware_app/service_manager/service_manager.h"
#include "firmware_app/status_server/status_server.h"
#include "hal/camera.h"
#include "hal/clock.h"
#include "hal/keyboards/keyboards.h"
#include "hal/machine/machine_state.h"
#include "hal/supervisor/camera_selector.h"
#include "pipeline/engine/camera_path.h"
#include "pipeline/scene/description/scene.h"

namespace pleinair::app {

/// The job of painting a camera's frames live.
struct LiveJob {
  hal::CameraSelector* selector = nullptr;
  hal::StreamRequest request;
  hal::Clock* clock = nullptr;
  PaintingOptions options;  ///< its output is ignored
  /// The parameters of the styles that keys may change to; their defaults where there are none.
  std::map<std::string, config::ParameterValues> otherStyles;
  std::vector<std::string> outputs;  ///< targets, as of hal::openOutput(); at least one
  OutputOpener openOutput;
  RuntimeSettings runtime;
  std::optional<hal::KeyboardChoice> keyboards;  ///< whose keys do what a window's do
  /// Starts the status server; may return null.
  std::function<std::unique_ptr<StatusServer>(StatusPages)> serveStatus;
  bool servesPictures = false;   ///< the server shows what the first output does
  bool waitsForCamera = false;   ///< at the start; after a loss it always waits
  bool waitsForOutputs = false;  ///< the same
  bool showsWaiting = true;      ///< on outputs of kinds that do (hal::OutputTraits)
  /// Where the last painting of such an output is kept, and was by the run before; empty: nowhere.
  std::filesystem::path state;
  hal::MachinePlaces health;  ///< what tells the state of the machine
  scene::Scene scene;
  std::filesystem::path snapshots;  ///< the folder that snapshots and look files go to
  /// The program and its options, without those that LiveTuning::arguments() gives.
  std::vector<std::string> command;
  LiveProcedure* procedure = nullptr;  ///< what keys step through; null: nothing
  std::filesystem::path procedureFolder;
  std::optional<std::size_t> machine;    ///< the model of the scene that the procedure is about
  bool showsInset = false;               ///< always, not only in doubt
  InputMap inputs;                       ///< what else steps through it
  StepCommandQueue* commands = nullptr;  ///< of the status server; null: it takes none
  std::filesystem::path frameLog;        ///< the file that FrameLogFile writes; empty: none
  /// Shown over the painting all the time, such as what is wrong with a site file; empty: nothing.
  std::string standingText;
  /// Shown beside it, and may change at any time; null: nothing. Any thread.
  std::function<std::string()> notice;
  /// A file that is made once paintings have been seen for a minute (SteadyPainting); empty: none.
  std::filesystem::path steadyMark;
  std::string siteOrigin;  ///< where the site file in force came from; empty: nowhere
  /// Whether to end, because another start would be set up differently; null: never.
  std::function<bool()> isToStartAnew;
  const ServiceManager* serviceManager = nullptr;  ///< that is told of the painting
  /// Reads the configuration again, after ReloadSignal::take(). Throws hal::Failure and
  /// config::ConfigError. Null: the signal is not looked for.
  std::function<Reload()> reload;

  bool tracksTags() const { return !scene.tags.empty() || !inputs.cards.empty(); }

  /// The request to the camera. Tags are found in whole frames; all else that trackers do, they do
  /// in an image of kTrackedSidePx, which some cameras make.
  hal::StreamRequest cameraRequest() const {
    hal::StreamRequest asked = request;
    if (!tracksTags()) asked.lumaSidePx = kTrackedSidePx;
    return asked;
  }
};

}  // namespace pleinair::app
