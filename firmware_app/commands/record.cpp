#include "firmware_app/commands/record.h"

#include <algorithm>
#include <chrono>

#include <fmt/format.h>

#include "firmware_app/painting.h"
#include "firmware_app/path_collisions.h"
#include "firmware_app/workbench_scene.h"
#include "hal/cameras/synthetic/open_synthetic.h"
#include "hal/cameras/synthetic/synthetic_camera.h"
#include "hal/error.h"

namespace pleinair::app {
namespace {

hal::SyntheticShot shotOf(const std::string& camera) {
  const auto shot = hal::orThrow(hal::syntheticShotOf(camera, "--camera"));
  if (shot) return *shot;
  throw hal::StartupError(hal::Error{
      .kind = hal::ErrorKind::kInvalidArgument,
      .subject = "--camera",
      .problem = fmt::format("unknown camera \"{}\"", camera),
      .remedy = "allowed: synthetic, synthetic:SHOT with a SHOT of " + hal::syntheticShotNames()});
}

hal::Duration seconds(double count) {
  return std::chrono::round<hal::Duration>(std::chrono::duration<double>(count));
}

hal::SyntheticOptions cameraOptions(const RecordOptions& options) {
  const double rows = std::max(options.size.height, 1);
  return {.size = options.size,
          .framePeriod = seconds(1 / options.framesPerSecond),
          .frameCount = options.frames,
          .shot = shotOf(options.camera),
          .seed = options.seed,
          .noiseSigma = options.noiseSigma,
          .exposureDriftStops = options.exposureDriftStops,
          .whiteBalanceDrift = options.whiteBalanceDrift,
          .rowTime = seconds(options.readoutMilliseconds / 1000 / rows)};
}

}  // namespace

int record(const RecordOptions& options) {
  hal::SteppedClock clock;
  hal::SyntheticCamera camera(cameraOptions(options), clock);
  if (options.writeScene) {
    refuseCollisions({}, {{"--output", options.output}, {"--write-scene", *options.writeScene}});
    hal::orThrow(writeWorkbenchScene(*options.writeScene, camera.truth(0), options.size));
  }
  return runPainting({.camera = &camera,
                      .options = {.output = options.output, .style = "none"},
                      .doing = "recording",
                      .done = "recorded"});
}

}  // namespace pleinair::app
