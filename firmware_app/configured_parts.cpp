#include "firmware_app/configured_parts.h"

#include <algorithm>
#include <chrono>
#include <string>
#include <system_error>

#include "config/suggestion.h"
#include "firmware_app/configuration_sections.h"
#include "pipeline/scene/scene_file.h"

namespace pleinair::app {
namespace {

hal::FrameSize frameSizeOf(const config::PixelSize& size) {
  return {size.width, size.height};
}

}  // namespace

PaintingOptions configuredPainting(const Configuration& configuration, PaintingOptions options) {
  const PaintingSettings painting = configuration.painting();
  options.style = painting.style;
  options.view = painting.view == kFinishedView ? "" : painting.view;
  if (painting.size != config::PixelSize{}) options.size = frameSizeOf(painting.size);
  options.parameters = configuration.styleParameters();
  return options;
}

scene::Scene configuredScene(const Configuration& configuration) {
  const std::filesystem::path file = configuration.painting().scene;
  return file == kNoFile ? scene::Scene{} : scene::loadScene(file);
}

void refuseSlipOfCamera(const Configuration& configuration) {
  const std::vector<std::string> names = cameraNames();
  const std::filesystem::path source = configuration.camera().source;
  const std::string name = source.filename().string();  // a file's folder may be before it
  std::error_code ignored;
  const bool isName = std::ranges::find(names, source.string()) != names.end();
  if (isName || std::filesystem::exists(source, ignored) || !config::nearest(name, names)) return;
  throw configuration.errorAt("camera.source", "found " + config::foundText(name, names),
                              config::listText(names) + ", or a recording that exists");
}

bool isSynthetic(const CameraSettings& camera) {
  return camera.source == "synthetic";
}

hal::SyntheticOptions syntheticOptions(const CameraSettings& camera) {
  const std::chrono::duration<double> period(1.0 / camera.framesPerSecond);
  return {.size = frameSizeOf(camera.size),
          .framePeriod = std::chrono::round<hal::Duration>(period),
          .seed = static_cast<std::uint32_t>(camera.seed),
          .noiseSigma = camera.noise};
}

std::vector<NamedPath> configuredFiles(const Configuration& configuration,
                                       const scene::Scene& scene) {
  std::vector<NamedPath> files;
  for (const std::filesystem::path& file : configuration.files()) {
    files.push_back({"the configuration", file});
  }
  const std::filesystem::path file = configuration.painting().scene;
  if (file != kNoFile) files.push_back({"--scene", file});
  for (const std::filesystem::path& each : scene.files) {
    files.push_back({"a file of the scene", each});
  }
  return files;
}

}  // namespace pleinair::app
