#include <algorithm>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include "firmware_app/cli/interrupt.h"
#include "firmware_app/cli/reload_signal.h"
#include "firmware_app/commands/commands.h"
#include "firmware_app/config/camera_selection.h"
#include "firmware_app/config/configuration_sections.h"
#include "firmware_app/config/configured_parts.h"
#include "firmware_app/config/reload.h"
#include "firmware_app/live/live_painting.h"
#include "firmware_app/live/screens/last_painting.h"
#include "firmware_app/live/status/machine_notice.h"
#include "firmware_app/overlay/machine.h"
#include "firmware_app/provisioning/provisioning.h"
#include "firmware_app/repair_station/step_inputs.h"
#include "firmware_app/service_manager/passed_socket.h"
#include "firmware_app/service_manager/service_manager.h"
#include "firmware_app/status_server/listen_address.h"
#include "hal/clock.h"
#include "hal/error.h"
#include "hal/outputs/registry.h"
#include "pipeline/procedure/step_command.h"
#include "pipeline/styles/registry.h"

namespace pleinair::app {
namespace {

constexpr std::string_view kTargetsKey = "output.targets";

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

/// The words of a command line that asks for the same, apart from how is painted.
std::vector<std::string> commandOf(const RunOptions& options) {
  const ConfigurationRequest& request = options.configuration;
  std::vector<std::string> words{"pleinair", "run"};
  const auto add = [&words](const std::string& option, const std::string& value) {
    words.insert(words.end(), {option, value});
  };
  if (request.profile) add("--profile", *request.profile);
  if (request.siteFile) add("--config", request.siteFile->string());
  for (const OptionValue& each : request.options) {
    const bool isTuned = each.key == kStyleKey || each.key == kLookKey || each.key == kViewKey;
    if (!isTuned && each.key != kTargetsKey) add(each.option, each.text);
    if (each.key != kTargetsKey) continue;
    for (const std::string& target : options.outputs) add(each.option, target);
  }
  for (const std::string& setting : request.set) {
    const std::string key = setting.substr(0, setting.find('='));
    const bool isTuned = key.find('.') == std::string::npos || key.starts_with("style.") ||
                         key == kStyleKey || key == kLookKey || key == kViewKey;
    if (!isTuned) add("--set", setting);
  }
  if (options.provisioning) add("--provisioning", options.provisioning->string());
  if (options.notice) add("--notice", options.notice->string());
  if (!options.shaderDirectory.empty()) add("--shaders", options.shaderDirectory.string());
  return words;
}

void requireFolder(const std::filesystem::path& folder) {
  std::error_code ignored;
  if (std::filesystem::is_directory(folder, ignored)) return;
  throw hal::Failure(hal::Error{.kind = hal::ErrorKind::kNotFound,
                                .subject = folder.string(),
                                .problem = "is not a folder",
                                .remedy = "make it, or give another folder"});
}

std::map<std::string, config::ParameterValues> parametersOfStyles(
    const Configuration& configuration) {
  std::map<std::string, config::ParameterValues> parameters;
  for (const styles::StyleKind* kind : styles::styleKinds()) {
    const std::string name(kind->name);
    parameters.emplace(name, configuration.parametersOfStyle(name));
  }
  return parameters;
}

/// The procedure that keys step through; nothing where the configuration names none.
std::unique_ptr<LiveProcedure> configuredProcedure(const Configuration& configuration,
                                                   const std::string& program,
                                                   const hal::Clock& clock,
                                                   bool keepsRecords = true) {
  const ProcedureSettings settings = configuration.procedure();
  if (settings.folder == kNoFile) return nullptr;
  const bool hasRecords = settings.records != kNoFile;
  if (hasRecords) requireFolder(settings.records);
  const bool records = hasRecords && keepsRecords;
  return std::make_unique<LiveProcedure>(
      LiveProcedureOptions{
          .folder = settings.folder,
          .language = settings.language == "default" ? std::string() : settings.language,
          .records = records ? settings.records : std::filesystem::path(),
          .operatorName =
              settings.operatorName == "unnamed" ? std::string() : settings.operatorName,
          .workOrder = settings.workOrder == "none" ? std::string() : settings.workOrder,
          .program = program,
          .stillsOfSteps = settings.stills == "steps"},
      clock);
}

/// Puts the procedure's machine into the scene. Nothing without a scene: then there is only the
/// instruction.
std::optional<std::size_t> placedMachine(const Configuration& configuration,
                                         const LiveProcedure* procedure, scene::Scene& scene) {
  if (procedure == nullptr || scene.models.empty()) return std::nullopt;
  const auto instruction = procedure->shown().procedure;
  const std::size_t machine = machineIn(scene, *instruction, configuration.procedure().machine);
  putMachine(scene, machine, *instruction);
  return machine;
}

/// A tag of the scene cannot be a command card, too: it is always in view.
void refuseCardsOf(const InputMap& inputs, const scene::Scene& scene) {
  for (const auto& [id, command] : inputs.cards) {
    if (scene.findTag(id) == nullptr) continue;
    throw hal::Failure(
        {.kind = hal::ErrorKind::kInvalidArgument,
         .subject = "input.map",
         .problem = fmt::format("the command card {} is a tag of the scene, too", id),
         .remedy = "another id for the card"});
  }
}

/// Files beside a site file that was copied must stay as they are: by them the copy is known.
void refuseWritingBeside(const Configuration& configuration, const std::filesystem::path& site) {
  const auto check = [&](std::string_view key, const std::filesystem::path& path) {
    const std::filesystem::path within = path.lexically_relative(site.parent_path());
    if (within.empty() || *within.begin() == "..") return;
    throw configuration.errorAt(key, "found a path beside site.toml, where nothing is written",
                                "an absolute path, such as /var/lib/pleinair/NAME");
  };
  const OutputSettings output = configuration.output();
  for (const std::filesystem::path& each : output.targets) check(kTargetsKey, each);
  check("output.snapshots", output.snapshots);
  check("procedure.records", configuration.procedure().records);
  check("runtime.frame_log", configuration.runtime().frameLog);
}

/// Throws for what would keep a painting from being begun, whatever devices there are. The request
/// names a site file.
void checkForPainting(const ConfigurationRequest& request, const RunOptions& options) {
  const Configuration configuration(request);
  configuration.attributing([&] {
    refuseWritingBeside(configuration, request.siteFile.value());
    scene::Scene scene = configuredScene(configuration);
    refuseSlipOfCamera(configuration);
    refuseCollisionsOf(configuration, scene);
    requireFolder(configuration.output().snapshots);
    hal::SteppedClock clock;
    const auto procedure = configuredProcedure(configuration, options.program, clock, false);
    placedMachine(configuration, procedure.get(), scene);
    refuseCardsOf(configuredInputMap(configuration), scene);
    makeCameraSelector(configuredCamera(configuration), clock);
    startParameters(configuredPainting(configuration, {}));
    const OutputSettings output = configuration.output();
    for (const std::string& target : targetsOf(output)) {
      hal::orThrow(hal::openOutput(target, output.options));
    }
  });
}

/// A site file that a person without a shell has given, where nobody with one did.
struct SiteSetup {
  Provisioned provisioned;
  std::string text;                  ///< for screens
  std::unique_ptr<SiteWatch> watch;  ///< null where nobody would start the program again
};

void reportSetup(const SiteSetup& setup) {
  const Provisioned& provisioned = setup.provisioned;
  if (!provisioned.origin.empty()) spdlog::info("set up by {}", provisioned.origin);
  for (const std::string& each : provisioned.problems) {
    spdlog::warn("{}: {}", provisioned.found.empty() ? "kept" : provisioned.found, each);
  }
  if (provisioned.problems.empty() && !setup.text.empty()) spdlog::info("not set up yet");
}

std::optional<SiteSetup> provisionedSite(const RunOptions& options, ConfigurationRequest& request,
                                         bool isService) {
  const bool isGiven =
      request.siteFile || std::ranges::any_of(request.environment, [](const auto& each) {
        return each.name == "PLEINAIR_CONFIG" && !each.value.empty();
      });
  const ProvisioningPlaces places = ProvisioningPlaces::of(options.provisioning, stateFolder());
  if (isGiven || places.folders.empty()) return std::nullopt;
  SiteSetup setup;
  if (isService) setup.watch = std::make_unique<SiteWatch>(places);
  setup.provisioned = provision(
      places, [&](const std::filesystem::path& siteFile, const std::optional<std::string>& text) {
        ConfigurationRequest candidate = request;
        candidate.siteFile = siteFile;
        candidate.siteText = text;
        checkForPainting(candidate, options);
      });
  std::error_code ignored;
  const bool hasOther = std::filesystem::exists(request.defaultSiteFile, ignored);
  setup.text = provisioningText(setup.provisioned, hasOther);
  reportSetup(setup);
  if (setup.provisioned.siteFile) request.siteFile = setup.provisioned.siteFile;
  return setup;
}

/// Empty: a run without a folder of its own makes none.
std::filesystem::path steadyMark() {
  const std::filesystem::path folder = runtimeFolder();
  return folder.empty() ? folder : folder / "steady";
}

/// The server's thread.
hal::Result<void> putCommand(StepCommandQueue& commands, std::string_view text) {
  auto command = procedure::parseStepCommand(text);
  if (!command) return tl::unexpected(std::move(command.error()));
  return commands.put(*std::move(command));
}

}  // namespace

int run(const RunOptions& options) {
  const Interrupt interrupt;  // first, so that a signal ends the program in order from here on
  const ServiceManager serviceManager(takeServiceEnvironment());
  // A terminal that hangs up ends the program; a service manager asks to reload.
  std::optional<ReloadSignal> reloadSignal;
  if (serviceManager.isThere()) reloadSignal.emplace();
  hal::FileDescriptor statusSocket = takePassedSocket();
  ConfigurationRequest request = options.configuration;
  const std::optional<SiteSetup> site = provisionedSite(options, request, serviceManager.isThere());
  std::optional<MachineNotice> notice;
  if (options.notice) notice.emplace(*options.notice);
  const Configuration configuration(request);
  return configuration.attributing([&] {
    scene::Scene scene = configuredScene(configuration);
    const OutputSettings output = configuration.output();
    refuseSlipOfCamera(configuration);
    refuseCollisionsOf(configuration, scene);
    requireFolder(output.snapshots);
    hal::SteadyClock clock;
    const InputMap inputs = configuredInputMap(configuration);
    {  // A start that is refused begins no record.
      scene::Scene trial = scene;
      const auto unrecorded = configuredProcedure(configuration, options.program, clock, false);
      placedMachine(configuration, unrecorded.get(), trial);
      refuseCardsOf(inputs, trial);
    }
    const auto procedure = configuredProcedure(configuration, options.program, clock);
    const std::optional<std::size_t> machine = placedMachine(configuration, procedure.get(), scene);
    StepCommandQueue commands;
    const std::string token =
        procedure ? configuredToken(configuration, static_cast<bool>(statusSocket)) : std::string();
    const CameraSettings camera = configuredCamera(configuration);
    const auto selector = makeCameraSelector(camera, clock);
    const PaintingOptions painting = configuredPainting(
        configuration,
        {.output = {}, .frames = options.frames, .shaderDirectory = options.shaderDirectory});
    return runLive(
        {.selector = selector.get(),
         .request = streamRequestOf(camera),
         .clock = &clock,
         .options = painting,
         .otherStyles = parametersOfStyles(configuration),
         .outputs = targetsOf(output),
         .openOutput = [options = output.options](
                           const std::string& target) { return hal::openOutput(target, options); },
         .runtime = configuration.runtime(),
         .keyboards = configuredKeyboards(configuration),
         .serveStatus =
             [&](StatusPages pages) {
               pages.commands = {.token = token, .take = [&commands](std::string_view text) {
                                   return putCommand(commands, text);
                                 }};
               return configuredStatusServer(configuration, std::move(pages),
                                             std::move(statusSocket));
             },
         .servesPictures = configuration.status().listen != kNoServer,
         .waitsForCamera = camera.wait,
         .waitsForOutputs = output.wait,
         .showsWaiting = output.waitingPictures,
         .state = output.keepsLastPainting ? stateFolder() : std::filesystem::path(),
         .health = {.state = stateFolder()},
         .scene = std::move(scene),
         .snapshots = output.snapshots,
         .command = commandOf(options),
         .procedure = procedure.get(),
         .procedureFolder = configuration.procedure().folder,
         .machine = machine,
         .showsInset = configuration.procedure().inset == "always",
         .inputs = inputs,
         .commands = token.empty() ? nullptr : &commands,
         .frameLog = frameLogOf(configuration),
         .standingText = site ? site->text : std::string(),
         .notice =
             notice ? std::function<std::string()>([&notice] { return notice->text(); }) : nullptr,
         .steadyMark = steadyMark(),
         .siteOrigin = site ? site->provisioned.origin : std::string(),
         .isToStartAnew = site && site->watch ? std::function<bool()>([&site] {
           return site->watch->hasChanged(!site->provisioned.problems.empty());
         })
                                              : nullptr,
         .serviceManager = serviceManager.isThere() ? &serviceManager : nullptr,
         .reload = [&]() -> Reload { return reloaded(request, configuration, painting); }});
  });
}

}  // namespace pleinair::app
