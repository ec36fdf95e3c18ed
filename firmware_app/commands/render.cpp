#include <memory>

#include "firmware_app/commands/commands.h"
#include "firmware_app/config/configured_parts.h"
#include "hal/cameras/recording/recording.h"

namespace pleinair::app {
namespace {

/// Refuses outputs that would overwrite an input or one another.
void refuseCollisionsOf(const RenderOptions& options, std::vector<NamedPath> read) {
  read.insert(read.begin(), {"--input", options.input});
  const PaintingOptions& painting = options.painting;
  std::vector<NamedPath> written{{"--output", painting.output}};
  if (painting.poses) written.push_back({"--poses", *painting.poses});
  if (painting.contactSheet) written.push_back({"--contact-sheet", *painting.contactSheet});
  refuseCollisions(read, written);
}

}  // namespace

int render(const RenderOptions& options) {
  const Configuration configuration(options.configuration);
  return configuration.attributing([&] {
    scene::Scene scene = configuredScene(configuration);
    refuseCollisionsOf(options, configuredFiles(configuration, scene));
    hal::SteppedClock clock;
    const std::unique_ptr<hal::Camera> recording = hal::openRecording(options.input, clock);
    return runPainting({.camera = recording.get(),
                        .options = configuredPainting(configuration, options.painting),
                        .scene = std::move(scene),
                        .progressVerb = "painting",
                        .summaryVerb = "painted"});
  });
}

}  // namespace pleinair::app
