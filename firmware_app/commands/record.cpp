#include "firmware_app/commands/record.h"

#include <fmt/format.h>

#include "firmware_app/desk_scene.h"
#include "firmware_app/painting.h"
#include "firmware_app/path_collisions.h"
#include "hal/cameras/synthetic/synthetic_camera.h"
#include "hal/error.h"

namespace pleinair::app {
namespace {

void requireKnownCamera(const std::string& name) {
  if (name == "synthetic") return;
  throw hal::StartupError(hal::Error{.kind = hal::ErrorKind::kInvalidArgument,
                                     .subject = "--camera",
                                     .problem = fmt::format("unknown camera \"{}\"", name),
                                     .remedy = "allowed: synthetic"});
}

}  // namespace

int record(const RecordOptions& options) {
  requireKnownCamera(options.camera);
  hal::SteppedClock clock;
  hal::SyntheticCamera camera(
      {.size = options.size, .frameCount = options.frames, .seed = options.seed}, clock);
  if (options.writeScene) {
    refuseCollisions({}, {{"--output", options.output}, {"--write-scene", *options.writeScene}});
    hal::orThrow(writeDeskScene(*options.writeScene, camera.truth(0), options.size));
  }
  return runPainting({.camera = &camera,
                      .options = {.output = options.output, .style = "none"},
                      .doing = "recording",
                      .done = "recorded"});
}

}  // namespace pleinair::app
