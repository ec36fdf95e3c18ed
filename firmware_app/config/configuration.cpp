#include "firmware_app/config/configuration.h"

#include <algorithm>
#include <functional>
#include <string_view>
#include <system_error>

#include <fmt/format.h>
#include <unistd.h>

#include "config/parameter_table.h"
#include "config/profiles.h"
#include "config/suggestion.h"
#include "firmware_app/config/configuration_sections.h"
#include "firmware_app/config/look_file.h"
#include "firmware_app/config/renamed.h"
#include "firmware_app/config/style_names.h"
#include "pipeline/engine/painter.h"
#include "pipeline/styles/registry.h"

namespace pleinair::app {
namespace {

namespace fs = std::filesystem;
using config::ConfigError;
using config::EnvironmentVariable;
using config::ParameterValues;
using config::Sections;
using config::TomlDocument;

constexpr std::string_view kProfileKey = "profile";
constexpr std::string_view kSiteFileVariable = "PLEINAIR_CONFIG";
constexpr std::string_view kProfileVariable = "PLEINAIR_PROFILE";

std::string styleSection(std::string_view style) {
  return fmt::format("style.{}", style);
}

/// The error of a file that cannot be read at all, after the place that names it.
ConfigError namedBy(const std::string& place, const ConfigError& error) {
  return ConfigError({.file = place, .problem = error.what()});
}

struct SiteFile {
  fs::path path;
  TomlDocument document;
};

std::optional<SiteFile> readSiteFile(const ConfigurationRequest& request) {
  if (request.siteFile) {
    const fs::path& path = *request.siteFile;
    return SiteFile{
        path, request.siteText
                  ? TomlDocument::parseText(*request.siteText, path.string(), path.parent_path())
                  : TomlDocument::parseFile(path)};
  }
  const auto variable =
      std::ranges::find(request.environment, kSiteFileVariable, &EnvironmentVariable::name);
  if (variable != request.environment.end()) {
    if (variable->value.empty()) return std::nullopt;
    try {
      return SiteFile{variable->value, TomlDocument::parseFile(variable->value)};
    } catch (const ConfigError& error) {
      if (error.line() > 0) throw;
      throw namedBy(std::string(kSiteFileVariable), error);
    }
  }
  std::error_code failure;
  const fs::path& path = request.defaultSiteFile;
  if (fs::status(path, failure).type() == fs::file_type::not_found) return std::nullopt;
  return SiteFile{path, TomlDocument::parseFile(path)};
}

void refuseScene(const SiteFile& site) {
  const config::TomlTable& root = site.document.root();
  for (const char* table : {"tag", "model"}) {
    if (!root.has(table)) continue;
    throw ConfigError({.file = site.path.string(),
                       .line = root.lineOf(table),
                       .problem = "seems to be a scene, not a configuration",
                       .allowed = "a site file; a scene is given as --scene FILE"});
  }
}

void applyEnvironment(Sections& sections, std::vector<EnvironmentVariable> variables) {
  // In an order of ours, so that of several errors it is always the same one that is told.
  std::ranges::sort(variables, {}, &EnvironmentVariable::name);
  const std::vector<std::string> others{std::string(kSiteFileVariable)};
  for (const EnvironmentVariable& variable : variables) {
    if (variable.name != kSiteFileVariable) sections.apply(variable, others);
  }
}

/// --set's "cell_size=8" is of the style in force, "camera.rate=15" names its section.
void applySetting(Sections& sections, const std::string& setting) {
  const std::size_t equals = setting.find('=');
  if (equals == std::string::npos || equals == 0) {
    throw ConfigError({.file = "--set",
                       .found = config::quoted(setting),
                       .allowed = "NAME=VALUE, such as cell_size=12 or camera.rate=15"});
  }
  const std::string name = setting.substr(0, equals);
  const bool hasSection = name.find('.') != std::string::npos;
  const std::string section = hasSection ? "" : styleSection(paintingOf(sections).style);
  sections.apply(name, std::string_view(setting).substr(equals + 1), "--set " + name, section);
}

/// Throws a ConfigError that names the place that gave the file, unless it has a line in the file.
LookFile lookFileOf(const Sections& sections) {
  try {
    return readLookFile(paintingOf(sections).look);
  } catch (const ConfigError& error) {
    if (error.line() > 0) throw;
    throw sections.errorAt(kLookKey, error.what(), {});
  }
}

/// The style with a look of this name, where there is one only; nothing where `style` has it.
std::optional<std::string> otherStyleWith(const std::string& look, const std::string& style) {
  std::vector<std::string> having;
  for (const styles::StyleKind* kind : styles::styleKinds()) {
    const bool hasIt =
        std::ranges::find(kind->looks, look, &styles::Look::name) != kind->looks.end();
    if (hasIt && kind->name == style) return std::nullopt;
    if (hasIt) having.emplace_back(kind->name);
  }
  return having.size() == 1 ? std::optional(having.front()) : std::nullopt;
}

/// A look that a layer names chooses its style, which the layer must not contradict.
void chooseStyleOfLook(Sections& sections, const Sections& before) {
  const PaintingSettings painting = paintingOf(sections);
  const std::string& place = sections.origin(kLookKey);
  if (place == before.origin(kLookKey)) return;
  if (!isLookFile(painting.look)) {
    const bool isOpen = sections.origin(kStyleKey) == before.origin(kStyleKey);
    const auto other = otherStyleWith(painting.look.string(), painting.style);
    if (isOpen && other) sections.apply(kStyleKey, *other, place);
    return;
  }
  const std::string style = lookFileOf(sections).style;
  if (style == painting.style) return;
  if (sections.origin(kStyleKey) != before.origin(kStyleKey)) {
    throw sections.errorAt(
        kLookKey, fmt::format("{} is a look of the style {}", painting.look.string(), style),
        fmt::format("a look of {}, or no other style", painting.style));
  }
  sections.apply(kStyleKey, style, place);
}

bool isStyle(const std::string& name) {
  const std::vector<std::string> names = styleNames();
  return std::ranges::find(names, name) != names.end();
}

std::string allowedStyles() {
  return "one of " + config::listText(styleNames());
}

/// Users take a look for a style: "oil".
void refuseUnknownStyle(const OptionValue& option) {
  if (isStyle(option.text)) return;
  throw ConfigError({.file = option.option,
                     .found = foundStyle(option.text, "--look {}"),
                     .allowed = allowedStyles()});
}

/// Lays a file over the sections. Refuses a look in place of a style, and a style's name in place
/// of the table of its parameters, with the key that either is given by.
void applyFile(Sections& sections, const TomlDocument& document) {
  const config::TomlTable& root = document.root();
  if (root.isString("style")) {
    throw root.error("style", "is the table of the styles' parameters",
                     "style = " + config::quoted(root.string("style")) + " in [painting]");
  }
  const auto painting = root.isTable("painting") ? root.optionalTable("painting") : std::nullopt;
  if (painting && painting->isString("style") && !isStyle(painting->string("style"))) {
    throw painting->error("style",
                          "found " + foundStyle(painting->string("style"), "look = \"{}\""),
                          allowedStyles());
  }
  sections.apply(document);
}

void applyCommandLine(Sections& sections, const ConfigurationRequest& request) {
  const Sections before = sections;
  if (request.profile) sections.apply(kProfileKey, *request.profile, "--profile");
  for (const OptionValue& each : request.options) {
    if (each.key == kStyleKey) refuseUnknownStyle(each);
    sections.apply(each.key, each.text, each.option);
  }
  // Those that name their section may change the style, which the others are of; so may a look.
  for (const bool hasSection : {true, false}) {
    if (!hasSection) chooseStyleOfLook(sections, before);
    for (const std::string& setting : request.set) {
      const bool isNamed = setting.substr(0, setting.find('=')).find('.') != std::string::npos;
      if (isNamed == hasSection) applySetting(sections, setting);
    }
  }
}

/// The profile that the strongest layer asks for.
std::optional<TomlDocument> readProfile(Sections sections, const ConfigurationRequest& request,
                                        const std::optional<SiteFile>& site,
                                        std::vector<fs::path>& files) {
  if (site) applyFile(sections, site->document);
  for (const EnvironmentVariable& variable : request.environment) {
    if (variable.name == kProfileVariable) sections.apply(variable);
  }
  if (request.profile) sections.apply(kProfileKey, *request.profile, "--profile");
  const fs::path wanted = profileOf(sections);
  if (wanted == kNoFile) return std::nullopt;
  for (const config::Profile& profile : config::profiles()) {
    if (wanted == profile.name) {
      return TomlDocument::parseText(profile.toml, fmt::format("profile {}", profile.name));
    }
  }
  files.push_back(wanted);
  try {
    return TomlDocument::parseFile(wanted);
  } catch (const ConfigError& error) {
    if (error.line() > 0) throw;
    throw sections.errorAt(kProfileKey, error.what(), {});
  }
}

/// `found` tells of a name that is not among `names`: foundLook() or foundView().
void checkName(const Sections& sections, std::string_view key, const std::string& name,
               std::string_view what, const std::vector<std::string>& names,
               std::string (*found)(const std::string&, std::string_view)) {
  if (std::ranges::find(names, name) != names.end()) return;
  if (const auto now = renamedValue(key, name)) {
    throw sections.errorAt(key, fmt::format("{} is now \"{}\"", config::quoted(name), *now), {});
  }
  const std::string style = paintingOf(sections).style;
  throw sections.errorAt(key, "found " + found(name, style),
                         fmt::format("{} of {}: {}", what, style, config::listText(names)));
}

/// The look and the view are the style's: those of another style are forgotten where a stronger
/// layer changes the style, and a layer's own must be the style's.
void validateStyle(Sections& sections, const Sections& before) {
  const PaintingSettings painting = paintingOf(sections);
  if (painting.style != paintingOf(before).style) {
    for (const std::string_view key : {kLookKey, kViewKey}) {
      if (sections.origin(key) == before.origin(key)) sections.forget(key);
    }
  }
  const PaintingSettings settled = paintingOf(sections);
  std::vector<std::string> looks{std::string(kDefaultLook)};
  for (const styles::Look& look : styles::styleKind(settled.style).looks) {
    looks.emplace_back(look.name);
  }
  if (!isLookFile(settled.look)) {
    checkName(sections, kLookKey, settled.look.filename().string(), "the looks", looks, foundLook);
  }
  std::vector<std::string> views{std::string(kFinishedView)};
  for (const DebugView& view : debugViewsOf(settled.style)) views.push_back(view.name);
  checkName(sections, kViewKey, settled.view, "the views", views, foundView);
}

/// Whether a value is this path, or a list that has it.
bool holdsPath(const config::ParameterValue& value, const std::string& path) {
  if (const auto* one = std::get_if<fs::path>(&value)) return one->string() == path;
  const auto* list = std::get_if<std::vector<fs::path>>(&value);
  return list != nullptr && std::ranges::find(*list, fs::path(path)) != list->end();
}

void lay(Sections& sections, const std::function<void(Sections&)>& layer) {
  const Sections before = sections;
  layer(sections);
  chooseStyleOfLook(sections, before);
  validateStyle(sections, before);
}

/// Puts the look's values where nobody gave any.
void applyLook(Sections& sections) {
  const PaintingSettings painting = paintingOf(sections);
  if (painting.look == kDefaultLook) return;
  const std::string section = styleSection(painting.style);
  const ParameterValues given = sections.values(section);
  const bool isFile = isLookFile(painting.look);
  const ParameterValues look =
      isFile ? lookFileOf(sections).values
             : styles::styleKind(painting.style).parametersOf(painting.look.string());
  ParameterValues values = given;
  for (std::size_t i = 0; i < given.list().descriptors().size(); ++i) {
    const std::string& name = given.list().descriptors()[i].name;
    const bool isOpen = given.origin(name) == config::kDefaultOrigin;
    if (!isOpen || look.origin(name) == config::kDefaultOrigin) continue;
    values =
        values.with(i, look.at(i), isFile ? look.origin(name) : "look " + painting.look.string());
  }
  sections.setValues(section, std::move(values));
}

/// The latency rises to max_latency, so that it cannot begin above it. Blames whichever was given.
void checkLatency(const Sections& sections) {
  constexpr std::string_view kKey = "runtime.latency";
  constexpr std::string_view kMaxKey = "runtime.max_latency";
  const RuntimeSettings runtime = runtimeOf(sections);
  if (runtime.latencyMs <= runtime.maxLatencyMs) return;
  if (sections.origin(kKey) != config::kDefaultOrigin) {
    throw sections.errorAt(kKey, fmt::format("found {}", runtime.latencyMs),
                           fmt::format("at most {}, which is {} ({})", runtime.maxLatencyMs,
                                       kMaxKey, sections.origin(kMaxKey)));
  }
  throw sections.errorAt(
      kMaxKey, fmt::format("found {}", runtime.maxLatencyMs),
      fmt::format("at least {}, which is {} ({})", runtime.latencyMs, kKey, sections.origin(kKey)));
}

}  // namespace

std::vector<EnvironmentVariable> environmentOfProcess() {
  std::vector<EnvironmentVariable> variables;
  for (char** each = environ; each != nullptr && *each != nullptr; ++each) {
    const std::string_view text = *each;
    const std::size_t equals = text.find('=');
    if (!text.starts_with(kVariablePrefix) || equals == std::string_view::npos) continue;
    const std::string name(text.substr(0, equals));
    // If a variable is given twice, the first counts, as for getenv().
    if (std::ranges::find(variables, name, &EnvironmentVariable::name) != variables.end()) continue;
    variables.push_back({name, std::string(text.substr(equals + 1))});
  }
  return variables;
}

Configuration::Configuration(const ConfigurationRequest& request)
    : sections_(defaultSections()), given_(sections_) {
  const std::optional<SiteFile> site = readSiteFile(request);
  if (site) {
    refuseScene(*site);
    files_.push_back(site->path);
  }
  if (const auto profile = readProfile(sections_, request, site, files_)) {
    if (profile->root().has(kProfileKey)) {
      throw profile->root().error(kProfileKey, "a profile builds on no other", "[sections] only");
    }
    lay(sections_, [&](Sections& sections) { applyFile(sections, *profile); });
  }
  if (site) lay(sections_, [&](Sections& sections) { applyFile(sections, site->document); });
  lay(sections_, [&](Sections& sections) { applyEnvironment(sections, request.environment); });
  lay(sections_, [&](Sections& sections) { applyCommandLine(sections, request); });
  checkLatency(sections_);
  given_ = sections_;
  if (const fs::path look = paintingOf(sections_).look; isLookFile(look)) files_.push_back(look);
  applyLook(sections_);
}

const ParameterValues& CameraSettings::tableOf(const hal::CameraKind& kind) const {
  const auto found = tables.find(kind.name);
  return found == tables.end() ? kind.defaults : found->second;
}

CameraSettings Configuration::camera() const {
  return cameraOf(sections_);
}

PaintingSettings Configuration::painting() const {
  return paintingOf(sections_);
}

OutputSettings Configuration::output() const {
  return outputOf(sections_);
}

InputSettings Configuration::input() const {
  return inputOf(sections_);
}

RuntimeSettings Configuration::runtime() const {
  return runtimeOf(sections_);
}

ProcedureSettings Configuration::procedure() const {
  return procedureOf(sections_);
}

StatusSettings Configuration::status() const {
  return statusOf(sections_);
}

const ParameterValues& Configuration::parametersOfStyle(std::string_view style) const {
  return sections_.values(styleSection(style));
}

const ParameterValues& Configuration::styleParameters() const {
  return sections_.values(styleSection(painting().style));
}

std::vector<std::string> Configuration::keysUnlike(const Configuration& other) const {
  std::vector<std::string> keys;
  for (const config::Section& section : sections_.all()) {
    const ParameterValues& values = section.values;
    const ParameterValues& others = other.sections_.values(section.name);
    for (std::size_t i = 0; i < values.list().descriptors().size(); ++i) {
      if (values.at(i) == others.at(i)) continue;
      const std::string& name = values.list().descriptors()[i].name;
      keys.push_back(section.name.empty() ? name : fmt::format("{}.{}", section.name, name));
    }
  }
  return keys;
}

std::string Configuration::toToml(config::Printed which) const {
  return "# What is in force of pleinair's configuration, and after each value where it came "
         "from.\n"
         "# It may be used as a site file; docs/configuration.md says how.\n\n" +
         (which == config::Printed::kAll ? sections_ : given_).toToml(which);
}

ConfigError Configuration::errorAt(std::string_view key, std::string problem,
                                   std::string allowed) const {
  return sections_.errorAt(key, std::move(problem), std::move(allowed));
}

std::optional<std::string> Configuration::keyThatNamed(const std::string& path) const {
  for (const config::Section& section : sections_.all()) {
    const auto descriptors = section.values.list().descriptors();
    for (std::size_t i = 0; i < descriptors.size(); ++i) {
      const config::ParameterDescriptor& each = descriptors[i];
      const std::string& place = section.values.origin(each.name);
      const bool isSaid = place == config::kDefaultOrigin || place.starts_with("--");
      if (isSaid || !holdsPath(section.values.at(i), path)) continue;
      return section.name.empty() ? each.name : fmt::format("{}.{}", section.name, each.name);
    }
  }
  return std::nullopt;
}

hal::Error Configuration::attributed(hal::Error error) const {
  if (const auto key = keyThatNamed(error.subject)) {
    error.subject = fmt::format("{}: {}: {}", origin(*key), *key, error.subject);
  }
  return error;
}

ConfigError Configuration::attributed(const ConfigError& error) const {
  // A line tells the place within the file that the value names.
  const auto key = error.line() > 0 ? std::nullopt : keyThatNamed(error.file());
  return key ? errorAt(*key, error.what(), {}) : error;
}

}  // namespace pleinair::app
