#include "firmware_app/live/camera_selection.h"

#include <filesystem>
#include <system_error>
#include <utility>

#include "config/suggestion.h"
#include "firmware_app/config/configuration_sections.h"
#include "firmware_app/config/configured_parts.h"
#include "hal/cameras/recording/recording_backend.h"
#include "hal/cameras/synthetic/synthetic_backend.h"
#include "hal/cameras/v4l2/v4l2_backend.h"
#include "hal/error.h"
#include "hal/numbered_path.h"
#include "hal/supervisor/worker_camera.h"

namespace pleinair::app {
namespace {

bool namesRecording(const std::filesystem::path& path) {
  std::error_code ignored;
  return std::filesystem::exists(path, ignored) || hal::looksNumbered(path);
}

hal::SelectableBackend synthetic(const CameraSettings& settings) {
  hal::SyntheticOptions options = syntheticOptions(settings);
  options.pacing = hal::Pacing::kRealTime;
  return {.backend = std::make_shared<hal::SyntheticBackend>(options), .isDevice = false};
}

hal::SelectableBackend recordings() {
  const hal::RecordingOptions options{.pacing = hal::Pacing::kRealTime, .loop = true};
  return {.backend = std::make_shared<hal::RecordingBackend>(options), .isDevice = false};
}

/// As the selector has it.
std::string choiceOf(const CameraSettings& settings) {
  const std::string source = settings.source.string();
  if (isSynthetic(settings)) {
    return "synthetic:" + std::string(hal::toString(syntheticOptions(settings).shot));
  }
  if (isRecording(settings) && namesRecording(settings.source)) return "recording:" + source;
  return source;
}

hal::Error noCamera(const std::string& source) {
  return {.kind = hal::ErrorKind::kNotFound,
          .subject = source,
          .problem = "is neither a camera nor a file",
          .remedy = "choose " + config::listText(cameraNames()) + ", " +
                    config::listText(openCameraNames()) + ", or the path of a recording"};
}

}  // namespace

std::vector<hal::SelectableBackend> deviceBackends() {
  return {{.backend = std::make_shared<hal::v4l2::V4l2Backend>()}};
}

std::unique_ptr<hal::CameraSelector> makeCameraSelector(const CameraSettings& settings,
                                                        hal::Clock& clock) {
  std::vector<hal::SelectableBackend> backends = deviceBackends();
  backends.push_back(synthetic(settings));
  backends.push_back(recordings());
  auto selector = std::make_unique<hal::CameraSelector>(std::move(backends), choiceOf(settings),
                                                        clock, hal::onThreadsOfTheirOwn());
  if (!selector->check()) throw hal::Failure(noCamera(settings.source.string()));
  return selector;
}

std::unique_ptr<hal::Camera> chosenCamera(const CameraSettings& settings, hal::Clock& clock) {
  hal::OpenedCamera opened =
      hal::orThrow(makeCameraSelector(settings, clock)->open(streamRequestOf(settings)));
  opened.camera->stop();
  return std::move(opened.camera);
}

std::unique_ptr<hal::HotplugMonitor> watchDevices(hal::CameraSupervisor& supervisor,
                                                  std::string& why) {
  hal::Result<std::unique_ptr<hal::DeviceEvents>> events = hal::udevEvents();
  if (!events) {
    why = events.error().message();
    return nullptr;
  }
  return std::make_unique<hal::HotplugMonitor>(
      std::move(*events), [&supervisor](const hal::DeviceEvent&) { supervisor.devicesChanged(); });
}

}  // namespace pleinair::app
