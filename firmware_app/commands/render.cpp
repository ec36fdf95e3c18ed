#include "firmware_app/commands/render.h"

#include <memory>

#include "firmware_app/painting.h"
#include "hal/cameras/recording/recording.h"
#include "hal/error.h"
#include "pipeline/scene/scene_file.h"

namespace pleinair::app {
namespace {

/// The painting would overwrite what it is painted from.
void refuseSameFile(const RenderOptions& options) {
  std::error_code error;
  if (!std::filesystem::equivalent(options.input, options.output, error) || error) return;
  throw hal::StartupError(hal::Error{.kind = hal::ErrorKind::kInvalidArgument,
                                     .subject = options.output.string(),
                                     .problem = "is the input as well",
                                     .remedy = "give --output another name"});
}

}  // namespace

int render(const RenderOptions& options) {
  refuseSameFile(options);
  hal::SteppedClock clock;
  const std::unique_ptr<hal::Camera> recording = hal::openRecording(options.input, clock);
  return runPainting({.camera = recording.get(),
                      .output = options.output,
                      .style = options.style,
                      .scene = options.scene ? scene::loadScene(*options.scene) : scene::Scene{},
                      .size = options.size,
                      .frames = options.frames,
                      .view = options.view,
                      .set = options.set,
                      .poses = options.poses,
                      .contactSheet = options.contactSheet,
                      .shaderDirectory = options.shaderDirectory,
                      .doing = "painting",
                      .done = "painted"});
}

}  // namespace pleinair::app
