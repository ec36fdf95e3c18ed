#include "firmware_app/config/requested_parts.h"

#include <algorithm>
#include <cerrno>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>

#include <fmt/format.h>
#include <unistd.h>

#include "config/config_error.h"
#include "firmware_app/config/camera_selection.h"
#include "firmware_app/config/configuration_sections.h"
#include "firmware_app/config/configured_parts.h"
#include "firmware_app/devices/inventory.h"
#include "firmware_app/status_server/listen_address.h"
#include "firmware_app/status_server/status_server.h"
#include "hal/clock.h"
#include "hal/numbered_path.h"
#include "hal/outputs/registry.h"

namespace pleinair::app {
namespace {

namespace fs = std::filesystem;
using doctor::RequestedPart;

/// The error that `action` throws, if any.
template <class Action>
std::optional<hal::Error> thrownBy(const Action& action) {
  try {
    action();
  } catch (const hal::Failure& failure) {
    return failure.error();
  } catch (const config::ConfigError& error) {
    return hal::Error{.kind = hal::ErrorKind::kInvalidArgument,
                      .subject = "configuration",
                      .problem = error.what(),
                      .remedy = {}};
  }
  return std::nullopt;
}

/// The node of a camera's id, which may be any of udev's names or a path.
std::string nodeOf(const std::string& id) {
  std::error_code ignored;
  for (const char* folder : {"", "/dev/v4l/by-id/", "/dev/v4l/by-path/"}) {
    if (id.empty() || (*folder == '\0' && !id.starts_with('/'))) continue;
    const fs::path node = fs::canonical(folder + id, ignored);
    if (!ignored) return node.string();
  }
  return {};
}

bool isRequested(const std::string& source, const hal::CameraDescription& camera) {
  constexpr std::string_view kSerial = "serial:";
  const std::string& backend = camera.identity.backend;
  if (source == "auto" || source == backend) return true;
  if (source.starts_with(kSerial)) return camera.serial == source.substr(kSerial.size());
  if (!source.starts_with(backend + ":")) return false;
  const std::string id = source.substr(backend.size() + 1);
  return id == camera.identity.id || (!camera.node.empty() && nodeOf(id) == camera.node);
}

std::optional<hal::Error> deviceProblem(const std::string& source) {
  const DeviceCameras there = listDeviceCameras(deviceBackends());
  std::optional<hal::Error> problem;
  for (const hal::CameraDescription& camera : there.cameras) {
    if (!isRequested(source, camera)) continue;
    if (!camera.problem && std::ranges::any_of(camera.modes, &hal::CameraMode::isSupported)) {
      return std::nullopt;
    }
    problem = camera.problem.value_or(
        hal::Error{.kind = hal::ErrorKind::kUnsupported,
                   .subject = camera.node,
                   .problem = "delivers no format that can be read",
                   .remedy = "choose another camera: `pleinair devices` lists what they offer"});
  }
  if (problem) return problem;
  return hal::Error{.kind = hal::ErrorKind::kNotFound,
                    .subject = source,
                    .problem = "no such camera is there",
                    .remedy = "plug it in, or choose one that `pleinair devices` lists"};
}

std::optional<hal::Error> recordingProblem(const CameraSettings& camera) {
  hal::SteadyClock clock;
  if (auto problem = thrownBy([&] { makeCameraSelector(camera, clock); })) return problem;
  const fs::path& path = camera.source;
  if (hal::looksNumbered(path) || access(path.c_str(), R_OK) == 0) return std::nullopt;
  return hal::errnoError(path.string(), "cannot be read", errno,
                         fmt::format("sudo chmod a+r '{}'", path.string()));
}

RequestedPart cameraPart(const Configuration& configuration) {
  const CameraSettings camera = configuredCamera(configuration);
  RequestedPart part{.part = "camera", .value = camera.source.string()};
  part.isChosen = configuration.origin("camera.source") != config::kDefaultOrigin && !camera.wait;
  part.problem = thrownBy([&] { refuseSlipOfCamera(configuration); });
  if (part.problem || isAlwaysThere(camera)) return part;
  part.isDevice = !isRecording(camera);
  part.problem = part.isDevice ? deviceProblem(part.value) : recordingProblem(camera);
  return part;
}

std::optional<hal::Error> outputProblem(const hal::OutputKind& kind, const std::string& target,
                                        const hal::OutputOptionsByKind& options) {
  if (auto folder = checkOutputFolder(target); !folder) return folder.error();
  if (auto opened = hal::openOutput(target, options); !opened) return opened.error();
  return kind.problemOf == nullptr ? std::nullopt : kind.problemOf(target);
}

/// Whether another program uses the part; usually that is pleinair's own service.
bool isUsedByAnother(const RequestedPart& part) {
  return part.problem && part.problem->kind == hal::ErrorKind::kBusy;
}

void addOutputs(const Configuration& configuration, std::vector<RequestedPart>& parts) {
  const OutputSettings settings = configuration.output();
  const bool isChosen = configuration.origin("output.targets") != config::kDefaultOrigin;
  for (const auto& each : settings.targets) {
    RequestedPart part{.part = "output", .value = std::string(each)};
    const auto kind = hal::outputKindOf(part.value);
    part.isDevice = kind && !(*kind)->traits.writesFiles;
    part.problem = kind ? outputProblem(**kind, part.value, settings.options) : kind.error();
    part.isChosen = isChosen && !isUsedByAnother(part);
    parts.push_back(std::move(part));
  }
}

}  // namespace

hal::Result<void> checkOutputFolder(const std::string& target) {
  const auto kind = hal::outputKindOf(target);
  if (!kind || !(*kind)->traits.writesFiles) return {};
  const fs::path path(target);
  std::error_code ignored;
  fs::path folder = path;
  if (!fs::is_directory(path, ignored)) {
    folder = (path.has_filename() ? path : path.parent_path()).parent_path();
  }
  if (folder.empty()) folder = ".";
  if (!fs::is_directory(folder, ignored)) {
    return tl::unexpected(hal::Error{.kind = hal::ErrorKind::kNotFound,
                                     .subject = target,
                                     .problem = "its folder " + folder.string() + " is not there",
                                     .remedy = fmt::format("mkdir -p '{}'", folder.string())});
  }
  if (access(folder.c_str(), W_OK | X_OK) == 0) return {};
  return tl::unexpected(hal::errnoError(
      target, "cannot write into " + folder.string(), errno,
      fmt::format("sudo chown $USER '{}', or give another place", folder.string())));
}

std::vector<RequestedPart> requestedParts(const Configuration& configuration) {
  std::vector<RequestedPart> parts{cameraPart(configuration)};
  addOutputs(configuration, parts);
  const PaintingSettings painting = configuration.painting();
  if (painting.scene != kNoFile) {
    parts.push_back({.part = "scene",
                     .value = painting.scene.string(),
                     .problem = thrownBy([&] { configuredScene(configuration); })});
  }
  parts.push_back({.part = "style",
                   .value = painting.style,
                   .problem = thrownBy([&] { configuredPainting(configuration, {}); })});
  if (const std::string listen = configuration.status().listen; listen != kNoServer) {
    const StatusPages pages{.page = [] { return std::string(); },
                            .picture = [] { return std::string(); },
                            .json = [] { return std::string(); },
                            .metrics = [] { return std::string(); },
                            .healthy = [] { return false; }};
    RequestedPart part{.part = "status", .value = listen, .isDevice = true};
    part.problem = thrownBy([&] { startStatusServer(listen, pages); });
    part.isChosen = !isUsedByAnother(part);
    parts.push_back(std::move(part));
  }
  return parts;
}

}  // namespace pleinair::app
