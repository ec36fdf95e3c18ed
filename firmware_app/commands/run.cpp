#include "firmware_app/commands/run.h"

#include <memory>
#include <system_error>
#include <utility>
#include <vector>

#include "firmware_app/configured_parts.h"
#include "firmware_app/live/camera_selection.h"
#include "firmware_app/live/live_painting.h"
#include "hal/clock.h"
#include "hal/error.h"

namespace pleinair::app {
namespace {

/// The painting would overwrite what it is painted from.
void refuseCollisionsOf(const Configuration& configuration, const scene::Scene& scene) {
  const std::filesystem::path target = configuration.output().target;
  if (target == "window") return;
  std::vector<NamedPath> read = configuredFiles(configuration, scene);
  const CameraSettings camera = configuration.camera();
  if (isRecording(camera)) read.insert(read.begin(), {"--camera", camera.source});
  refuseCollisions(read, {{"--output", target}});
}

void requireFolder(const std::filesystem::path& folder) {
  std::error_code ignored;
  if (std::filesystem::is_directory(folder, ignored)) return;
  throw hal::StartupError(hal::Error{.kind = hal::ErrorKind::kNotFound,
                                     .subject = folder.string(),
                                     .problem = "is not a folder",
                                     .remedy = "make it, or give another --stills DIR"});
}

/// [camera], which delivers the painting's size where nobody chose another.
CameraSettings liveCamera(const Configuration& configuration) {
  CameraSettings camera = configuration.camera();
  const config::PixelSize size = configuration.painting().size;
  const bool isOpen = configuration.origin("camera.size") == config::kDefaultOrigin;
  if (isOpen && size != config::PixelSize{}) camera.size = size;
  return camera;
}

}  // namespace

int run(const RunOptions& options) {
  const Configuration configuration(options.configuration);
  return configuration.blaming([&] {
    scene::Scene scene = configuredScene(configuration);
    const OutputSettings output = configuration.output();
    refuseSlipOfCamera(configuration);
    refuseCollisionsOf(configuration, scene);
    requireFolder(output.stills);
    hal::SteadyClock clock;
    const std::unique_ptr<hal::Camera> camera = chosenCamera(liveCamera(configuration), clock);
    return runLive(
        {.camera = camera.get(),
         .clock = &clock,
         .options = configuredPainting(configuration, {.output = output.target,
                                                       .frames = options.frames,
                                                       .shaderDirectory = options.shaderDirectory}),
         .scene = std::move(scene),
         .stills = output.stills});
  });
}

}  // namespace pleinair::app
