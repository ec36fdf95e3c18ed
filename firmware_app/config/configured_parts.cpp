#include "firmware_app/config/configured_parts.h"

#include <algorithm>
#include <array>
#include <fstream>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include <spdlog/spdlog.h>

#include "config/config_error.h"
#include "config/suggestion.h"
#include "config/toml_reader.h"
#include "firmware_app/config/configuration_sections.h"
#include "firmware_app/config/control_text.h"
#include "firmware_app/status_server/listen_address.h"
#include "hal/cameras/registry.h"
#include "hal/cameras/synthetic/synthetic_kind.h"
#include "hal/error.h"
#include "hal/outputs/registry.h"
#include "pipeline/scene/description/scene_file.h"
#include "pipeline/styles/registry.h"

namespace pleinair::app {
namespace {

/// "synthetic" of "synthetic:pan" and of "synthetic".
std::string_view wordBeforeColon(std::string_view source) {
  return source.substr(0, std::min(source.find(':'), source.size()));
}

/// "synthetic:nope": a kind whose cameras have fixed names has none of this one.
bool isUnlistedCamera(const std::string& source) {
  return !isCameraName(source) &&
         std::ranges::any_of(hal::cameraKinds(), [&](const hal::CameraKind* kind) {
           return kind->naming == hal::CameraNaming::kListed &&
                  source.starts_with(std::string(kind->name) + ":");
         });
}

/// Precondition of a secret: nobody else may read it.
std::string readToken(const std::filesystem::path& file) {
  constexpr std::size_t kLeast = 16;
  constexpr std::size_t kMost = 200;
  const auto fault = [&](hal::ErrorKind kind, std::string problem, std::string remedy) {
    return hal::Failure({.kind = kind,
                         .subject = file.string(),
                         .problem = std::move(problem),
                         .remedy = std::move(remedy)});
  };
  std::error_code failure;
  const auto status = std::filesystem::status(file, failure);
  std::ifstream stream(file);
  if (!std::filesystem::is_regular_file(status) || !stream) {
    throw fault(hal::ErrorKind::kNotFound, "cannot be read",
                "openssl rand -hex 16 > FILE; chmod 600 FILE");
  }
  using std::filesystem::perms;
  if ((status.permissions() & (perms::group_all | perms::others_all)) != perms::none) {
    throw fault(hal::ErrorKind::kPermissionDenied, "may be read by others",
                "chmod 600 " + file.string());
  }
  std::string token;
  std::getline(stream, token);
  const bool isPlain = std::ranges::all_of(token, [](char c) { return c > ' ' && c <= '~'; });
  if (token.size() < kLeast || token.size() > kMost || !isPlain) {
    throw fault(hal::ErrorKind::kInvalidInput, "holds no secret of 16 to 200 characters",
                "openssl rand -hex 16 > " + file.string());
  }
  return token;
}

hal::FrameSize frameSizeOf(const config::PixelSize& size) {
  return {size.width, size.height};
}

/// "serail:123", where "serial:NUMBER" is known.
bool isSlipOfOpenName(const std::string& name) {
  const std::size_t colon = name.find(':');
  if (colon == std::string::npos) return false;
  std::vector<std::string> words;
  for (const std::string& each : openCameraNames()) words.emplace_back(wordBeforeColon(each));
  return config::nearest(name.substr(0, colon), words).has_value();
}

/// Whether a file has a table of a site or look file that no scene has.
bool seemsConfiguration(const std::filesystem::path& file) {
  try {
    const config::TomlDocument document = config::TomlDocument::parseFile(file);
    constexpr std::array kTables{"painting", "output", "runtime", "style"};
    return std::ranges::any_of(kTables,
                               [&](const char* table) { return document.root().isTable(table); });
  } catch (const config::ConfigError&) {
    return false;
  }
}

}  // namespace

PaintingOptions configuredPainting(const Configuration& configuration, PaintingOptions options) {
  const PaintingSettings painting = configuration.painting();
  options.style = painting.style;
  options.view = painting.view == kFinishedView ? "" : painting.view;
  if (painting.size != config::PixelSize{}) options.size = frameSizeOf(painting.size);
  options.parameters = configuration.styleParameters();
  options.isCameraMounted = configuration.camera().isMounted;
  const auto check = styles::styleKind(options.style).check;
  if (check != nullptr) hal::orThrow(check(*options.parameters));
  return options;
}

scene::Scene sceneOfFile(const std::filesystem::path& file) {
  try {
    return scene::loadScene(file);
  } catch (const config::ConfigError&) {
    if (!seemsConfiguration(file)) throw;
    throw config::ConfigError({.file = file.string(),
                               .problem = "seems to be a configuration, not a scene",
                               .allowed = "a file of tags and models; a configuration is given as "
                                          "--config FILE"});
  }
}

scene::Scene configuredScene(const Configuration& configuration) {
  const std::filesystem::path file = configuration.painting().scene;
  return file == kNoFile ? scene::Scene{} : sceneOfFile(file);
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
  if (isUnlistedCamera(source.string())) {
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
  const std::string source = camera.source.string();
  return isCameraName(source) && wordBeforeColon(source) == hal::synthetic::cameraKind().name;
}

bool isAlwaysThere(const CameraSettings& camera) {
  const std::string source = camera.source.string();
  return isCameraName(source) &&
         std::ranges::any_of(hal::cameraKinds(), [&](const hal::CameraKind* kind) {
           return kind->naming == hal::CameraNaming::kListed &&
                  wordBeforeColon(source) == kind->name;
         });
}

hal::CameraBackendOptions backendOptionsOf(const CameraSettings& camera, hal::Pacing pacing) {
  return {.size = frameSizeOf(camera.size),
          .framePeriod = hal::fromSeconds(1.0 / camera.framesPerSecond),
          .pacing = pacing};
}

hal::SyntheticOptions syntheticOptions(const CameraSettings& camera) {
  hal::SyntheticOptions options =
      hal::synthetic::optionsOf(camera.tableOf(hal::synthetic::cameraKind()),
                                backendOptionsOf(camera, hal::Pacing::kStepped));
  const std::string source = camera.source.string();
  const std::size_t colon = source.find(':');
  if (isSynthetic(camera) && colon != std::string::npos) {
    options.shot = hal::syntheticShotNamed(source.substr(colon + 1)).value();
  }
  return options;
}

hal::StreamRequest streamRequestOf(const CameraSettings& camera) {
  hal::StreamRequest request{
      .size = frameSizeOf(camera.size),
      .framePeriod = hal::fromSeconds(1.0 / camera.framesPerSecond),
      .controls = {.gain = kShareText.parsed(camera.gain),
                   .focus = kShareText.parsed(camera.focus),
                   .whiteBalance = kWhiteBalanceText.parsed(camera.whiteBalance)}};
  if (const auto exposure = kExposureText.parsed(camera.exposure)) {
    const double* time = std::get_if<double>(&*exposure);
    request.controls.exposure = time == nullptr ? hal::AutomaticOr<hal::Duration>(hal::Automatic{})
                                                : hal::fromMilliseconds(*time);
  }
  return request;
}

std::optional<hal::KeyboardChoice> configuredKeyboards(const Configuration& configuration) {
  const InputSettings input = configuration.input();
  auto choice = hal::KeyboardChoice::parsed(input.keyboards);
  if (!choice) return std::nullopt;
  choice->grabs = input.grab;
  for (const MappedDevice& each : configuredInputMap(configuration).devices) {
    choice->except.push_back(each.device);
  }
  if (!choice->all) return choice->named.empty() ? std::nullopt : choice;
  bool isOnConsole = false;
  for (const std::filesystem::path& target : configuration.output().targets) {
    const auto kind = hal::outputKindOf(target.string());
    if (!kind) continue;  // told when it is opened
    if ((*kind)->traits.isOnMainThread) return std::nullopt;
    isOnConsole = isOnConsole || (*kind)->traits.isOnConsole;
  }
  return isOnConsole ? choice : std::nullopt;
}

InputMap configuredInputMap(const Configuration& configuration) {
  const std::filesystem::path map = configuration.input().map;
  return map == kNoFile ? InputMap{} : readInputMap(map);
}

std::string configuredToken(const Configuration& configuration, bool isPassed) {
  const StatusSettings status = configuration.status();
  if (status.tokenFile == kNoFile) return {};
  const auto address = hal::orThrow(parseListen(status.listen));
  if (!isPassed && address &&
      !isLoopback(reinterpret_cast<const sockaddr*>(&address->storage))) {  // NOLINT(*-cast)
    throw hal::Failure({.kind = hal::ErrorKind::kInvalidArgument,
                        .subject = "status.token_file",
                        .problem = "commands come from this machine alone, and the server listens "
                                   "beyond it, at " +
                                   status.listen,
                        .remedy = "status.listen = \"127.0.0.1:9117\""});
  }
  return readToken(status.tokenFile);
}

std::unique_ptr<StatusServer> configuredStatusServer(const Configuration& configuration,
                                                     StatusPages pages,
                                                     hal::FileDescriptor passed) {
  auto server = passed ? startStatusServer(std::move(passed), std::move(pages))
                       : startStatusServer(configuration.status().listen, std::move(pages));
  if (server) {
    spdlog::info("status: http://{}/ (for programs: /status, /metrics and /healthz)",
                 server->address());
  }
  return server;
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
