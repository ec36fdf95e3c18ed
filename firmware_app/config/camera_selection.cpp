#include "firmware_app/config/camera_selection.h"

#include <cstddef>
#include <filesystem>
#include <span>
#include <system_error>
#include <utility>

#include "config/suggestion.h"
#include "firmware_app/config/configuration_sections.h"
#include "firmware_app/config/configured_parts.h"
#include "hal/cameras/registry.h"
#include "hal/error.h"
#include "hal/numbered_path.h"
#include "hal/supervisor/worker_camera.h"

namespace pleinair::app {
namespace {

bool namesRecording(const std::filesystem::path& path) {
  std::error_code ignored;
  return std::filesystem::exists(path, ignored) || hal::looksNumbered(path);
}

/// As the selector has it.
std::string choiceOf(const CameraSettings& settings,
                     std::span<const hal::SelectableBackend> backends) {
  std::string source = settings.source.string();
  const auto kinds = hal::cameraKinds();
  for (std::size_t i = 0; i < kinds.size(); ++i) {
    const hal::CameraKind& kind = *kinds[i];
    // The bare name of a kind whose cameras are always there means its first camera, which then
    // reports its own errors.
    if (kind.naming == hal::CameraNaming::kListed && source == kind.name) {
      const auto cameras = backends[i].backend->list();
      if (cameras && !cameras->empty()) return source + ":" + cameras->front().identity.id;
    }
    if (kind.naming == hal::CameraNaming::kPaths && isRecording(settings) &&
        namesRecording(settings.source)) {
      return std::string(kind.name) + ":" + source;
    }
  }
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
  std::vector<hal::SelectableBackend> backends;
  for (const hal::CameraKind* kind : hal::cameraKinds()) {
    if (kind->naming != hal::CameraNaming::kDevices) continue;
    backends.push_back({.backend = kind->open(kind->defaults, {})});
  }
  return backends;
}

std::vector<hal::SelectableBackend> deviceBackends(const CameraSettings& settings) {
  std::vector<hal::SelectableBackend> backends;
  for (const hal::CameraKind* kind : hal::cameraKinds()) {
    if (kind->naming != hal::CameraNaming::kDevices) continue;
    backends.push_back({.backend = kind->open(settings.tableOf(*kind), {})});
  }
  return backends;
}

std::unique_ptr<hal::CameraSelector> makeCameraSelector(const CameraSettings& settings,
                                                        hal::Clock& clock) {
  const hal::CameraBackendOptions options = backendOptionsOf(settings, hal::Pacing::kRealTime);
  std::vector<hal::SelectableBackend> backends;
  for (const hal::CameraKind* kind : hal::cameraKinds()) {
    backends.push_back({.backend = kind->open(settings.tableOf(*kind), options),
                        .isDevice = kind->naming == hal::CameraNaming::kDevices});
  }
  std::string choice = choiceOf(settings, backends);
  auto selector = std::make_unique<hal::CameraSelector>(std::move(backends), std::move(choice),
                                                        clock, hal::onDriverThreads());
  if (!selector->check()) throw hal::Failure(noCamera(settings.source.string()));
  return selector;
}

std::unique_ptr<hal::Camera> chosenCamera(const CameraSettings& settings, hal::Clock& clock) {
  hal::OpenedCamera opened =
      hal::orThrow(makeCameraSelector(settings, clock)->open(streamRequestOf(settings)));
  opened.camera->stop();
  return std::move(opened.camera);
}

std::unique_ptr<hal::HotplugMonitor> watchDevices(
    std::function<void(const hal::DeviceEvent&)> changed, std::string& why) {
  hal::Result<std::unique_ptr<hal::DeviceEvents>> events = hal::udevEvents();
  if (!events) {
    why = events.error().message();
    return nullptr;
  }
  return std::make_unique<hal::HotplugMonitor>(std::move(*events), std::move(changed));
}

}  // namespace pleinair::app
