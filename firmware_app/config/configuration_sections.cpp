#include "firmware_app/config/configuration_sections.h"

#include <algorithm>
#include <iterator>
#include <memory>
#include <utility>

#include <fmt/format.h>

#include "config/parameter_table.h"
#include "config/profiles.h"
#include "firmware_app/config/control_text.h"
#include "firmware_app/config/renamed.h"
#include "firmware_app/config/style_names.h"
#include "firmware_app/status_server/listen_address.h"
#include "hal/cameras/registry.h"
#include "hal/keyboards/keyboards.h"
#include "hal/pixel_format.h"
#include "pipeline/engine/painter.h"
#include "pipeline/styles/registry.h"

namespace pleinair::app {
namespace {

using config::choiceParameter;
using config::numberParameter;
using config::ParameterTable;
using config::pathListParameter;
using config::pathParameter;
using config::sizeParameter;
using config::switchParameter;
using config::TakesEffect;
using config::textParameter;

constexpr config::SizeRange kSizes{.maxSide = hal::kMaxSidePixels, .maxPixels = hal::kMaxPixels};

struct ProfileSettings {
  std::filesystem::path profile{kNoFile};
};

const ParameterTable<ProfileSettings>& profileTable() {
  static const ParameterTable<ProfileSettings> kTable{pathParameter(
      "profile", &ProfileSettings::profile,
      [] {
        std::vector<std::string> words = config::profileNames();
        words.emplace_back(kNoFile);
        return words;
      }(),
      "Profile that these keys override: a built-in one, or a file.", TakesEffect::kRestart,
      ".toml")};
  return kTable;
}

config::ParameterBinding<CameraSettings> controlParameter(const std::string& name,
                                                          std::string CameraSettings::*member,
                                                          const ControlText& control,
                                                          const std::string& help) {
  return textParameter(name, member, control.allowed(), help, TakesEffect::kRestart,
                       [control](std::string_view text) { return control.takes(text); });
}

const ParameterTable<CameraSettings>& cameraTable() {
  static const ParameterTable<CameraSettings> kTable{
      pathParameter(
          "source", &CameraSettings::source, cameraNames(),
          "The camera: a device, by id or serial number or the first that works; \"synthetic\", a "
          "workbench made by code, or another of its shots; or a recording's path.",
          TakesEffect::kRestart, {}, openCameraNames()),
      switchParameter("wait", &CameraSettings::wait,
                      "Whether to wait for a camera where there is none at the start; one that is "
                      "lost later is always waited for.",
                      TakesEffect::kRestart),
      sizeParameter("size", &CameraSettings::size, kSizes, {},
                    "Of the synthetic camera's frames, or what a device is asked for; it gives the "
                    "nearest that it has. Movies have even sides."),
      numberParameter("rate", &CameraSettings::framesPerSecond,
                      {.min = 1, .max = 240, .unit = "frames a second"},
                      "How many frames the synthetic camera makes, or a device is asked for.",
                      TakesEffect::kRestart),
      switchParameter(
          "mounted", &CameraSettings::isMounted,
          "Whether it is fixed to something that does not move, so that a person who is "
          "close, before a plain wall, is not taken for its own motion.",
          TakesEffect::kRestart),
      controlParameter("exposure", &CameraSettings::exposure, kExposureText,
                       "Of a device, in milliseconds; \"device\": as it is set."),
      controlParameter("gain", &CameraSettings::gain, kShareText,
                       "Of a device, as a share of its range; \"device\": as it is set."),
      controlParameter("focus", &CameraSettings::focus, kShareText,
                       "Of a device, as a share of its range; \"device\": as it is set."),
      controlParameter("white_balance", &CameraSettings::whiteBalance, kWhiteBalanceText,
                       "Of a device, the light's colour temperature; \"device\": as it is set.")};
  return kTable;
}

std::vector<std::string> lookNames() {
  std::vector<std::string> names{std::string(kDefaultLook)};
  for (const styles::StyleKind* kind : styles::styleKinds()) {
    for (const styles::Look& look : kind->looks) names.emplace_back(look.name);
  }
  return names;
}

const ParameterTable<PaintingSettings>& paintingTable() {
  using P = PaintingSettings;
  static const ParameterTable<P> kTable{
      choiceParameter("style", &P::style, styleNames(),
                      "How to paint; `pleinair styles` lists styles, looks and views.",
                      TakesEffect::kRestart),
      pathParameter("look", &P::look, lookNames(),
                    "A preset of the style's parameters; \"default\" is its first one; a look file "
                    "(.toml) chooses its style, too.",
                    TakesEffect::kLive),
      textParameter("view", &P::view, "finished, or a view of the style",
                    "What is shown of the painting."),
      sizeParameter("size", &P::size, kSizes, {"camera"},
                    "Of the painting; \"camera\": as its frames. Movies have even sides."),
      pathParameter("scene", &P::scene, {std::string(kNoFile)}, "Tags and models (TOML).")};
  return kTable;
}

const ParameterTable<OutputSettings>& outputTable() {
  static constexpr std::size_t kMaxTargets = 8;
  static const ParameterTable<OutputSettings> kTable{
      pathListParameter("targets", &OutputSettings::targets, {.min = 1, .max = kMaxTargets},
                        hal::outputWords(), hal::outputPrefixes(),
                        "Where a live painting goes; docs/outputs.md lists the kinds.",
                        "a movie's or pictures' path (a folder as ./NAME or NAME/)",
                        [](std::string_view text) {
                          const std::string target(text);
                          // Other mistakes are told when it is opened.
                          return !hal::isBareWord(target) || hal::outputKindOf(target).has_value();
                        }),
      switchParameter("wait", &OutputSettings::wait,
                      "Whether to wait for a display or loopback that is not there at the start; "
                      "one that is lost later is always waited for.",
                      TakesEffect::kRestart),
      switchParameter("waiting_pictures", &OutputSettings::waitingPictures,
                      "Whether a display or window shows a picture that says what it waits for "
                      "while there is no painting; else the last one stays, or black.",
                      TakesEffect::kRestart),
      switchParameter("keep_last_painting", &OutputSettings::keepsLastPainting,
                      "Whether the last painting of a display is kept for the first picture of the "
                      "next run, in the state folder, at most once a minute.",
                      TakesEffect::kRestart),
      pathParameter("snapshots", &OutputSettings::snapshots, {"."},
                    "The folder that the window's key s saves to; \".\": where the program runs.")};
  return kTable;
}

std::string sectionOf(const hal::OutputKind& kind) {
  return fmt::format("output.{}", kind.name);
}

config::ParameterDescriptor descriptorOf(const hal::OutputOption& option) {
  config::ParameterDescriptor descriptor{.name = option.name, .help = option.help};
  if (option.isSwitch) {
    descriptor.defaultValue = false;
  } else if (option.choices.empty()) {
    descriptor.defaultValue = option.initial;
    descriptor.textAllowed = option.allowed;
    descriptor.takesText = option.takes;
  } else {
    descriptor.defaultValue = config::ChoiceIndex{0};
    descriptor.choices = option.choices;
  }
  descriptor.takesEffect = TakesEffect::kRestart;
  return descriptor;
}

/// [output.KIND] of each kind that has options.
std::vector<config::Section> outputKindSections() {
  std::vector<config::Section> sections;
  for (const hal::OutputKind& kind : hal::outputKinds()) {
    std::vector<config::ParameterDescriptor> descriptors;
    for (const hal::OutputOption& option : kind.options) {
      descriptors.push_back(descriptorOf(option));
    }
    if (descriptors.empty()) continue;
    sections.push_back({sectionOf(kind), fmt::format("Outputs of the kind {}.", kind.name),
                        config::ParameterValues(std::make_shared<const config::ParameterList>(
                            std::move(descriptors)))});
  }
  return sections;
}

const ParameterTable<InputSettings>& inputTable() {
  static const ParameterTable<InputSettings> kTable{
      textParameter(
          "keyboards", &InputSettings::keyboards,
          "auto, none, or names and paths with commas between them",
          "Keyboards whose keys do what a window's do; \"auto\": all, where there is a "
          "screen without a desktop and no window.",
          TakesEffect::kRestart,
          [](std::string_view text) { return hal::KeyboardChoice::parsed(text).has_value(); }),
      switchParameter("grab", &InputSettings::grab,
                      "Whether their keys reach pleinair alone, and neither the console nor other "
                      "programs; Ctrl+Alt+F2 too then does nothing.",
                      TakesEffect::kRestart),
      pathParameter("map", &InputSettings::map, {std::string(kNoFile)},
                    "The file that says which pedals, buttons and command cards lead through a "
                    "procedure; `pleinair inputs --learn` writes it.",
                    TakesEffect::kRestart, ".toml")};
  return kTable;
}

std::vector<std::string> qualityChoices() {
  std::vector<std::string> names{"auto"};
  for (const QualityLevel& level : qualityLevels()) names.push_back(level.name);
  return names;
}

const ParameterTable<RuntimeSettings>& runtimeTable() {
  using R = RuntimeSettings;
  static const ParameterTable<R> kTable{
      numberParameter("latency", &R::latencyMs, {.min = 10, .max = 2000, .unit = "ms"},
                      "Time from a frame's capture until it is shown.", TakesEffect::kRestart),
      numberParameter(
          "max_latency", &R::maxLatencyMs, {.min = 10, .max = 4000, .unit = "ms"},
          "Limit of a raised latency, if even the lowest quality misses the configured one.",
          TakesEffect::kRestart),
      choiceParameter("quality", &R::quality, qualityChoices(),
                      "Quality level to keep; \"auto\": the best level that keeps up.",
                      TakesEffect::kRestart),
      numberParameter("rate", &R::rate, {.min = 0, .max = 240, .unit = "frames a second"},
                      "Frame rate that quality is lowered for; 0: the camera's.",
                      TakesEffect::kRestart),
      numberParameter("heat_margin", &R::heatMargin, {.min = 0, .max = 40, .unit = "K"},
                      "How near a sensor may come to the temperature from which on the machine "
                      "slows itself down before quality is lowered; 0: heat does not matter.",
                      TakesEffect::kRestart),
      pathParameter("frame_log", &R::frameLog, {std::string(kNoFile)},
                    "A file (CSV) that gets a row for each frame of each output: when it was due, "
                    "when it was shown, at which refresh, or why not.")};
  return kTable;
}

std::string cameraSection(const hal::CameraKind& kind) {
  return fmt::format("camera.{}", kind.name);
}

const ParameterTable<ProcedureSettings>& procedureTable() {
  using P = ProcedureSettings;
  static const ParameterTable<P> kTable{
      pathParameter(
          "folder", &P::folder, {std::string(kNoFile)},
          "The folder of a work instruction that keys step through (docs/repair-station.md)."),
      textParameter("language", &P::language,
                    "a language of the procedure, or \"default\": its first",
                    "Language of its texts.", TakesEffect::kRestart),
      textParameter("machine", &P::machine, "a model of the scene, or \"auto\": the one that fits",
                    "The model of the scene that it is about; it takes the procedure's parts.",
                    TakesEffect::kRestart),
      textParameter(
          "inset", &P::inset, "\"auto\" or \"always\"",
          "When the step is drawn from the model beside: auto, where it cannot be shown on "
          "the machine.",
          TakesEffect::kRestart),
      pathParameter("records", &P::records, {std::string(kNoFile)},
                    "The folder that records of what was done go to; the newest one that is not "
                    "signed off is resumed."),
      textParameter("operator", &P::operatorName, "a name", "Who works, for the record.",
                    TakesEffect::kRestart),
      textParameter("work_order", &P::workOrder, "a text", "The work order, for the record.",
                    TakesEffect::kRestart),
      choiceParameter("stills", &P::stills, {"checks", "steps"},
                      "Which pictures of the camera go into the record: those of checks, or also "
                      "one before and after each step.",
                      TakesEffect::kRestart)};
  return kTable;
}

const ParameterTable<StatusSettings>& statusTable() {
  static const ParameterTable<StatusSettings> kTable{
      textParameter(
          "listen", &StatusSettings::listen, std::string(kAllowedListen),
          "Address of the HTTP server of /status, /metrics and /healthz.", TakesEffect::kRestart,
          [](std::string_view text) { return parseListen(std::string(text)).has_value(); }),
      pathParameter("token_file", &StatusSettings::tokenFile, {std::string(kNoFile)},
                    "A file with the secret of those who may POST commands to a procedure, from "
                    "this machine alone; none: nobody may.")};
  return kTable;
}

}  // namespace

std::vector<std::string> cameraNames() {
  std::vector<std::string> names{"auto"};
  for (const hal::CameraKind* kind : hal::cameraKinds()) {
    if (kind->naming == hal::CameraNaming::kPaths) continue;
    names.emplace_back(kind->name);
    if (kind->naming != hal::CameraNaming::kListed) continue;
    const auto cameras = kind->open(kind->defaults, {})->list();
    if (!cameras) continue;
    for (const hal::CameraDescription& each : *cameras) {
      names.push_back(fmt::format("{}:{}", kind->name, each.identity.id));
    }
  }
  return names;
}

std::vector<std::string> openCameraNames() {
  std::vector<std::string> names;
  for (const hal::CameraKind* kind : hal::cameraKinds()) {
    if (kind->naming != hal::CameraNaming::kDevices) continue;
    names.push_back(fmt::format("{}:ID", kind->name));
  }
  names.emplace_back("serial:NUMBER");
  return names;
}

bool isCameraName(std::string_view source) {
  return !cameraTable().defaults().list().descriptors()[0].isPath(source);
}

std::string namedCamera(const std::string& source) {
  for (const hal::CameraKind* kind : hal::cameraKinds()) {
    if (kind->nodePrefix.empty() || !source.starts_with(kind->nodePrefix)) continue;
    return fmt::format("{}:{}", kind->name, source);
  }
  return source;
}

config::Sections defaultSections() {
  std::vector<config::Section> sections{
      {"", "", profileTable().defaults()},
      {"camera", "The camera that is painted live or recorded.", cameraTable().defaults()}};
  for (const hal::CameraKind* kind : hal::cameraKinds()) {
    sections.push_back({cameraSection(*kind),
                        fmt::format("The camera {}: {}.", kind->name, kind->help), kind->defaults});
  }
  sections.push_back({"painting", "The painting.", paintingTable().defaults()});
  sections.push_back({"output", "The outputs of the painting.", outputTable().defaults()});
  for (config::Section& section : outputKindSections()) sections.push_back(std::move(section));
  sections.push_back({"input", "Keys without a desktop.", inputTable().defaults()});
  sections.push_back(
      {"runtime", "Latency and quality of live painting.", runtimeTable().defaults()});
  sections.push_back(
      {"procedure", "A work instruction that is carried out.", procedureTable().defaults()});
  sections.push_back(
      {"status", "Status of the running program over HTTP.", statusTable().defaults()});
  for (const styles::StyleKind* kind : styles::styleKinds()) {
    sections.push_back({fmt::format("style.{}", kind->name),
                        fmt::format("The style {}: {}.", kind->name, kind->help), kind->defaults});
  }
  return config::Sections(std::move(sections), std::string(kVariablePrefix), renamedKeys());
}

std::filesystem::path profileOf(const config::Sections& sections) {
  return profileTable().typed(sections.values("")).profile;
}

CameraSettings cameraOf(const config::Sections& sections) {
  CameraSettings settings = cameraTable().typed(sections.values("camera"));
  settings.source = namedCamera(settings.source.string());
  for (const hal::CameraKind* kind : hal::cameraKinds()) {
    settings.tables.emplace(kind->name, sections.values(cameraSection(*kind)));
  }
  return settings;
}

PaintingSettings paintingOf(const config::Sections& sections) {
  return paintingTable().typed(sections.values("painting"));
}

OutputSettings outputOf(const config::Sections& sections) {
  OutputSettings settings = outputTable().typed(sections.values("output"));
  for (const hal::OutputKind& kind : hal::outputKinds()) {
    if (kind.options.empty()) continue;
    const config::ParameterValues& values = sections.values(sectionOf(kind));
    for (const hal::OutputOption& option : kind.options) {
      settings.options[kind.name][option.name] = values.text(option.name);
    }
  }
  return settings;
}

InputSettings inputOf(const config::Sections& sections) {
  return inputTable().typed(sections.values("input"));
}

RuntimeSettings runtimeOf(const config::Sections& sections) {
  return runtimeTable().typed(sections.values("runtime"));
}

ProcedureSettings procedureOf(const config::Sections& sections) {
  return procedureTable().typed(sections.values("procedure"));
}

StatusSettings statusOf(const config::Sections& sections) {
  return statusTable().typed(sections.values("status"));
}

}  // namespace pleinair::app
