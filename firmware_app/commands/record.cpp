#include <memory>
#include <string>

#include <fmt/format.h>

#include "firmware_app/commands/commands.h"
#include "firmware_app/config/camera_selection.h"
#include "firmware_app/config/configured_parts.h"
#include "firmware_app/offline/capturing.h"
#include "firmware_app/scene/workbench_scene.h"
#include "hal/cameras/recording/recording_kind.h"

namespace pleinair::app {
namespace {

void refuseCollisionsOf(const RecordOptions& options, const Configuration& configuration) {
  std::vector<NamedPath> read = configuredFiles(configuration, {});
  const CameraSettings camera = configuration.camera();
  if (isRecording(camera)) read.push_back({"--camera", camera.source});
  std::vector<NamedPath> written{{"--output", options.output}};
  if (options.writeScene) written.push_back({"--write-scene", *options.writeScene});
  refuseCollisions(read, written);
}

bool isDevice(const CameraSettings& settings) {
  return !isSynthetic(settings) && !isRecording(settings);
}

/// Opens the camera, stopped, and writes its scene if requested.
std::unique_ptr<hal::Camera> openCamera(const RecordOptions& options,
                                        const CameraSettings& settings, hal::Clock& clock) {
  if (!isSynthetic(settings)) {
    if (options.writeScene) {
      const std::string source = isDevice(settings) ? "a device" : "a recording";
      throw hal::Failure({.kind = hal::ErrorKind::kInvalidArgument,
                          .subject = "--write-scene",
                          .problem = "the scene of " + source + " is not known",
                          .remedy = "leave it out, or record the synthetic camera"});
    }
    if (isDevice(settings)) return chosenCamera(settings, clock);
    const hal::CameraKind& kind = hal::recording::cameraKind();
    return kind.open(settings.tableOf(kind), backendOptionsOf(settings, hal::Pacing::kStepped))
        ->make(settings.source.string(), clock);
  }
  hal::SyntheticOptions synthetic = syntheticOptions(settings);
  synthetic.frameCount = options.frames;
  auto camera = std::make_unique<hal::SyntheticCamera>(synthetic, clock);
  if (options.writeScene) {
    hal::orThrow(writeWorkbenchScene(*options.writeScene, camera->truth(0), synthetic.size));
  }
  return camera;
}

std::string textOf(const CameraSettings& camera) {
  return fmt::format("{}x{} at {}; exposure {}, gain {}, focus {}, white_balance {}",
                     camera.size.width, camera.size.height, camera.framesPerSecond, camera.exposure,
                     camera.gain, camera.focus, camera.whiteBalance);
}

void refuseOtherThanMatroska(const std::filesystem::path& output) {
  if (output.extension() == ".mkv") return;
  throw hal::Failure({.kind = hal::ErrorKind::kInvalidArgument,
                      .subject = "--output",
                      .problem = "--lossless does not write \"" + output.string() + "\"",
                      .remedy = "give a name that ends in .mkv"});
}

}  // namespace

int record(const RecordOptions& options) {
  const Configuration configuration(options.configuration);
  return configuration.attributing([&] {
    refuseSlipOfCamera(configuration);
    refuseCollisionsOf(options, configuration);
    if (options.lossless) refuseOtherThanMatroska(options.output);
    const CameraSettings settings = configuration.camera();
    hal::SteppedClock stepped;
    hal::SteadyClock steady;  // the clock of a real device
    hal::Clock& clock = isDevice(settings) ? static_cast<hal::Clock&>(steady) : stepped;
    const auto camera = openCamera(options, settings, clock);
    if (options.lossless) {
      return runCapture({.camera = camera.get(),
                         .request = streamRequestOf(settings),
                         .requestText = textOf(settings),
                         .clock = &clock,
                         .output = options.output,
                         .frames = options.frames});
    }
    return runPainting(
        {.camera = camera.get(),
         .request = streamRequestOf(settings),
         .clock = isDevice(settings) ? &steady : nullptr,
         .options = {.output = options.output, .style = "none", .frames = options.frames},
         .progressVerb = "recording",
         .summaryVerb = "recorded"});
  });
}

}  // namespace pleinair::app
