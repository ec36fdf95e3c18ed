#include "firmware_app/commands/render.h"

#include <memory>

#include "firmware_app/path_collisions.h"
#include "hal/cameras/recording/recording.h"
#include "pipeline/scene/scene_file.h"

namespace pleinair::app {
namespace {

/// The painting would overwrite what it is painted from, or itself.
void refuseCollisionsOf(const RenderOptions& options) {
  std::vector<NamedPath> read{{"--input", options.input}};
  if (options.scene) read.push_back({"--scene", *options.scene});
  std::vector<NamedPath> written{{"--output", options.output}};
  if (options.poses) written.push_back({"--poses", *options.poses});
  if (options.contactSheet) written.push_back({"--contact-sheet", *options.contactSheet});
  refuseCollisions(read, written);
}

}  // namespace

int render(const RenderOptions& options) {
  refuseCollisionsOf(options);
  hal::SteppedClock clock;
  const std::unique_ptr<hal::Camera> recording = hal::openRecording(options.input, clock);
  return runPainting({.camera = recording.get(),
                      .options = options,
                      .scene = options.scene ? scene::loadScene(*options.scene) : scene::Scene{},
                      .doing = "painting",
                      .done = "painted"});
}

}  // namespace pleinair::app
