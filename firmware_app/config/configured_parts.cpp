#include "firmware_app/config/configured_parts.h"

#include <algorithm>
#include <chrono>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "config/config_error.h"
#include "config/suggestion.h"
#include "firmware_app/config/configuration_sections.h"
#include "firmware_app/config/control_text.h"
#include "hal/cameras/synthetic/open_synthetic.h"
#include "hal/error.h"
#include "pipeline/scene/description/scene_file.h"
#include "pipeline/styles/registry.h"

namespace pleinair::app {
namespace {

hal::Result<std::optional<hal::SyntheticShot>> shotOf(const CameraSettings& camera) {
  return hal::syntheticShotOf(camera.source.string(), "camera.source");
}

hal::FrameSize frameSizeOf(const config::PixelSize& size) {
  return {size.width, size.height};
}

/// "serail:123", where "serial:NUMBER" is known.
bool isSlipOfOpenName(const std::string& name) {
  const std::size_t colon = name.find(':');
  if (colon == std::string::npos) return false;
  std::vector<std::string> words;
  for (const std::string& each : openCameraNames()) words.push_back(each.substr(0, each.find(':')));
  return config::nearest(name.substr(0, colon), words).has_value();
}

}  // namespace

PaintingOptions configuredPainting(const Configuration& configuration, PaintingOptions options) {
  const PaintingSettings painting = configuration.painting();
  options.style = painting.style;
  options.view = painting.view == kFinishedView ? "" : painting.view;
  if (painting.size != config::PixelSize{}) options.size = frameSizeOf(painting.size);
  options.parameters = configuration.styleParameters();
  const auto check = styles::styleKind(options.style).check;
  if (check != nullptr) hal::orThrow(check(*options.parameters));
  return options;
}

scene::Scene configuredScene(const Configuration& configuration) {
  const std::filesystem::path file = configuration.painting().scene;
  return file == kNoFile ? scene::Scene{} : scene::loadScene(file);
}

CameraSettings configuredCamera(const Configuration& configuration) {
  CameraSettings camera = configuration.camera();
  const config::PixelSize size = configuration.painting().size;
  const bool isOpen = configuration.origin("camera.size") == config::kDefaultOrigin;
  if (isOpen && size != config::PixelSize{}) camera.size = size;
  return camera;
}

void refuseSlipOfCamera(const Configuration& configuration) {
  const std::vector<std::string> names = cameraNames();
  const std::filesystem::path source = configuration.camera().source;
  const std::string name = source.filename().string();  // a file's folder may be before it
  std::error_code ignored;
  if (!shotOf(configuration.camera())) {
    throw configuration.errorAt("camera.source",
                                "found " + config::foundText(source.string(), names),
                                config::listText(names));
  }
  if (isCameraName(source.string()) || std::filesystem::exists(source, ignored)) return;
  if (!config::nearest(name, names) && !isSlipOfOpenName(name)) return;
  throw configuration.errorAt("camera.source", "found " + config::foundText(name, names),
                              config::listText(names) + ", " + config::listText(openCameraNames()) +
                                  ", or a recording that exists");
}

bool isRecording(const CameraSettings& camera) {
  return !isCameraName(camera.source.string());
}

bool isSynthetic(const CameraSettings& camera) {
  return shotOf(camera).value_or(std::nullopt).has_value();
}

hal::SyntheticOptions syntheticOptions(const CameraSettings& camera) {
  const std::chrono::duration<double> period(1.0 / camera.framesPerSecond);
  const auto rowTime =
      period * (camera.readout / std::max(camera.size.height, 1));  // rounded down: it must fit
  return {.size = frameSizeOf(camera.size),
          .framePeriod = std::chrono::round<hal::Duration>(period),
          .shot = shotOf(camera).value_or(std::nullopt).value_or(hal::SyntheticOptions().shot),
          .seed = static_cast<std::uint32_t>(camera.seed),
          .noiseSigma = camera.noise,
          .exposureDriftStops = camera.exposureDriftStops,
          .whiteBalanceDrift = camera.whiteBalanceDrift,
          .rowTime = std::chrono::duration_cast<hal::Duration>(rowTime)};
}

hal::StreamRequest streamRequestOf(const CameraSettings& camera) {
  const std::chrono::duration<double> period(1.0 / camera.framesPerSecond);
  hal::StreamRequest request{
      .size = frameSizeOf(camera.size),
      .framePeriod = std::chrono::round<hal::Duration>(period),
      .controls = {.gain = kShareText.parsed(camera.gain),
                   .focus = kShareText.parsed(camera.focus),
                   .whiteBalance = kWhiteBalanceText.parsed(camera.whiteBalance)}};
  if (const auto exposure = kExposureText.parsed(camera.exposure)) {
    using Milliseconds = std::chrono::duration<double, std::milli>;
    const double* time = std::get_if<double>(&*exposure);
    request.controls.exposure = time == nullptr
                                    ? hal::AutomaticOr<hal::Duration>(hal::Automatic{})
                                    : std::chrono::round<hal::Duration>(Milliseconds(*time));
  }
  return request;
}

std::unique_ptr<StatusServer> configuredStatusServer(const Configuration& configuration,
                                                     StatusPages pages) {
  return startStatusServer(configuration.status().listen, std::move(pages));
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
