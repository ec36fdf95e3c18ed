#include <algorithm>
#include <filesystem>
#include <memory>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "firmware_app/cli/interrupt.h"
#include "firmware_app/commands/commands.h"
#include "firmware_app/config/camera_selection.h"
#include "firmware_app/config/configuration_sections.h"
#include "firmware_app/config/configured_parts.h"
#include "firmware_app/live/last_painting.h"
#include "firmware_app/live/live_painting.h"
#include "hal/clock.h"
#include "hal/error.h"
#include "hal/outputs/registry.h"

namespace pleinair::app {
namespace {

std::vector<std::string> targetsOf(const OutputSettings& output) {
  std::vector<std::string> targets;
  for (const std::filesystem::path& each : output.targets) targets.push_back(each.string());
  return targets;
}

bool isFile(const std::string& target) {
  const auto kind = hal::outputKindOf(target);
  return kind && (*kind)->traits.writesFiles;
}

void refuseTwice(std::vector<std::string> targets) {
  std::ranges::sort(targets);
  const auto twice = std::ranges::adjacent_find(targets);
  if (twice == targets.end()) return;
  throw hal::Failure(hal::Error{.kind = hal::ErrorKind::kInvalidArgument,
                                .subject = "--output",
                                .problem = "is given twice: " + *twice,
                                .remedy = "give each output once"});
}

/// Empty: none.
std::filesystem::path frameLogOf(const Configuration& configuration) {
  std::filesystem::path file = configuration.runtime().frameLog;
  return file == kNoFile ? std::filesystem::path() : file;
}

/// Refuses outputs that would overwrite an input or one another.
void refuseCollisionsOf(const Configuration& configuration, const scene::Scene& scene) {
  std::vector<NamedPath> read = configuredFiles(configuration, scene);
  const CameraSettings camera = configuration.camera();
  if (isRecording(camera)) read.insert(read.begin(), {"--camera", camera.source});
  std::vector<NamedPath> written;
  for (const std::string& target : targetsOf(configuration.output())) {
    if (isFile(target)) written.push_back({"--output", target});
  }
  if (const auto log = frameLogOf(configuration); !log.empty()) {
    written.push_back({"runtime.frame_log", log});
  }
  refuseCollisions(read, written);
  refuseTwice(targetsOf(configuration.output()));
}

void requireFolder(const std::filesystem::path& folder) {
  std::error_code ignored;
  if (std::filesystem::is_directory(folder, ignored)) return;
  throw hal::Failure(hal::Error{.kind = hal::ErrorKind::kNotFound,
                                .subject = folder.string(),
                                .problem = "is not a folder",
                                .remedy = "make it, or give another --snapshots DIR"});
}

}  // namespace

int run(const RunOptions& options) {
  const Interrupt interrupt;  // first, so that a signal ends the program in order from here on
  const Configuration configuration(options.configuration);
  return configuration.attributing([&] {
    scene::Scene scene = configuredScene(configuration);
    const OutputSettings output = configuration.output();
    refuseSlipOfCamera(configuration);
    refuseCollisionsOf(configuration, scene);
    requireFolder(output.snapshots);
    hal::SteadyClock clock;
    const CameraSettings camera = configuredCamera(configuration);
    const auto selector = makeCameraSelector(camera, clock);
    return runLive(
        {.selector = selector.get(),
         .request = streamRequestOf(camera),
         .clock = &clock,
         .options = configuredPainting(
             configuration,
             {.output = {}, .frames = options.frames, .shaderDirectory = options.shaderDirectory}),
         .outputs = targetsOf(output),
         .openOutput = [options = output.options](
                           const std::string& target) { return hal::openOutput(target, options); },
         .runtime = configuration.runtime(),
         .keyboards = configuredKeyboards(configuration),
         .serveStatus =
             [&](StatusPages pages) {
               return configuredStatusServer(configuration, std::move(pages));
             },
         .waitsForCamera = camera.wait,
         .waitsForOutputs = output.wait,
         .showsWaiting = output.waitingPictures,
         .state = output.keepsLastPainting ? stateFolder() : std::filesystem::path(),
         .scene = std::move(scene),
         .snapshots = output.snapshots,
         .frameLog = frameLogOf(configuration)});
  });
}

}  // namespace pleinair::app
