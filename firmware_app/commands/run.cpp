#include "firmware_app/commands/run.h"

#include <memory>
#include <system_error>
#include <vector>

#include "firmware_app/live/live_painting.h"
#include "firmware_app/live/open_camera.h"
#include "firmware_app/path_collisions.h"
#include "hal/clock.h"
#include "hal/error.h"
#include "pipeline/scene/scene_file.h"

namespace pleinair::app {
namespace {

/// The painting would overwrite what it is painted from.
void refuseCollisionsOf(const RunOptions& options) {
  if (options.output == "window") return;
  std::vector<NamedPath> read{{"--camera", options.camera}};
  if (options.scene) read.push_back({"--scene", *options.scene});
  refuseCollisions(read, {{"--output", options.output}});
}

void requireFolder(const std::filesystem::path& folder) {
  std::error_code ignored;
  if (std::filesystem::is_directory(folder, ignored)) return;
  throw hal::StartupError(hal::Error{.kind = hal::ErrorKind::kNotFound,
                                     .subject = folder.string(),
                                     .problem = "is not a folder",
                                     .remedy = "make it, or give another --stills DIR"});
}

}  // namespace

int run(const RunOptions& options) {
  refuseCollisionsOf(options);
  requireFolder(options.stills);
  hal::SteadyClock clock;
  const std::unique_ptr<hal::Camera> camera = openCamera(options.camera, options.size, clock);
  return runLive({.camera = camera.get(),
                  .clock = &clock,
                  .options = options,
                  .scene = options.scene ? scene::loadScene(*options.scene) : scene::Scene{},
                  .stills = options.stills});
}

}  // namespace pleinair::app
