#include "pipeline/procedure/step_table.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "config/suggestion.h"
#include "pipeline/procedure/node_names.h"
#include "pipeline/procedure/units.h"
#include "pipeline/procedure/unknown_keys.h"

namespace pleinair::procedure {
namespace {

using config::TomlTable;

constexpr std::string_view kEndName = "end";

/// Lists of a machine's nodes are long: the first ones, and how many there are.
std::string shortListText(std::span<const std::string> names) {
  constexpr std::size_t kShown = 12;
  if (names.size() <= kShown) return config::listText(names);
  return fmt::format("{} … ({} in all)", config::listText(names.first(kShown)), names.size());
}

config::ConfigError unknownNode(const TomlTable& table, std::string_view key,
                                const std::string& name, const scene::Model& model) {
  const std::vector<std::string> known = nodeNames(model);
  return table.error(
      key, unknownNodeText(name, model),
      shortListText(known) + "; `pleinair procedure check FOLDER --nodes` lists them");
}

std::vector<std::size_t> readParts(const TomlTable& table, std::string_view key,
                                   const Procedure& procedure) {
  const auto names = table.optionalStrings(key, {1, 1000}, "an array of nodes of the model");
  if (!names || !procedure.model) return {};
  std::vector<std::size_t> parts;
  for (const std::string& name : *names) {
    const std::vector<std::size_t> found = partsNamed(*procedure.model, name);
    if (found.empty()) throw unknownNode(table, key, name, *procedure.model);
    parts.insert(parts.end(), found.begin(), found.end());
  }
  std::ranges::sort(parts);
  const auto repeated = std::ranges::unique(parts);
  parts.erase(repeated.begin(), repeated.end());
  return parts;
}

template <class Item>
std::vector<std::size_t> readReferences(const TomlTable& table, std::string_view key,
                                        const std::vector<Item>& items) {
  const auto names =
      table.optionalStrings(key, {0, 50}, fmt::format("an array of names of [{}]", key));
  std::vector<std::size_t> indices;
  if (!names) return indices;
  std::vector<std::string> ids;
  for (const Item& item : items) ids.push_back(item.id);
  for (const std::string& name : *names) {
    const auto found = std::ranges::find(ids, name);
    if (found == ids.end()) {
      throw table.error(key, "found " + config::foundText(name, ids), shortListText(ids));
    }
    indices.push_back(static_cast<std::size_t>(found - ids.begin()));
  }
  return indices;
}

constexpr std::array<config::Choice<Motion>, 6> kMotions{{{"none", Motion::kNone},
                                                          {"pull", Motion::kPull},
                                                          {"push", Motion::kPush},
                                                          {"turn", Motion::kTurn},
                                                          {"screw", Motion::kScrew},
                                                          {"unscrew", Motion::kUnscrew}}};
constexpr std::array<config::Choice<PartView>, 6> kViews{{{"plain", PartView::kPlain},
                                                          {"focus", PartView::kFocus},
                                                          {"tint", PartView::kTint},
                                                          {"outline", PartView::kOutline},
                                                          {"hidden", PartView::kHidden},
                                                          {"ghost", PartView::kGhost}}};

constexpr std::array<config::Choice<glm::dvec3>, 6> kAxes{{{"x", {1.0, 0.0, 0.0}},
                                                           {"-x", {-1.0, 0.0, 0.0}},
                                                           {"y", {0.0, 1.0, 0.0}},
                                                           {"-y", {0.0, -1.0, 0.0}},
                                                           {"z", {0.0, 0.0, 1.0}},
                                                           {"-z", {0.0, 0.0, -1.0}}}};

/// Calls `take` with each part that a key of the table names, and the key.
template <class Take>
void forNamedParts(const TomlTable& table, const Procedure& procedure, Take take) {
  for (const std::string& key : table.keys()) {
    const std::vector<std::size_t> parts =
        procedure.model ? partsNamed(*procedure.model, key) : std::vector<std::size_t>{};
    if (procedure.model && parts.empty()) throw unknownNode(table, key, key, *procedure.model);
    take(key, parts);
  }
}

/// How far an exploded view may take parts: more is a mistake in the unit.
double mostApartMetres(const Procedure& procedure) {
  constexpr double kMostRadii = 6.0;  // of the machine: three times its size
  constexpr double kWithoutModel = 100.0;
  if (!procedure.model) return kWithoutModel;
  const double radius = procedure.unitMetres * scene::boundingSphere(*procedure.model).radiusMetres;
  return radius > 0.0 ? kMostRadii * radius : kWithoutModel;
}

/// motion, axis, show = { NODE = "tint", … } and apart = { NODE = 0.08, … }
void readViews(const TomlTable& table, const Procedure& procedure, Step& step) {
  if (table.has("motion")) step.motion = table.choice("motion", kMotions);
  if (table.has("axis")) step.axis = table.choice("axis", kAxes);
  if (const std::optional<TomlTable> show = table.optionalTable("show")) {
    forNamedParts(*show, procedure, [&](const std::string& key, const auto& parts) {
      const PartView view = show->choice(key, kViews);
      for (const std::size_t part : parts) step.views.emplace_back(part, view);
    });
  }
  if (const std::optional<TomlTable> apart = table.optionalTable("apart")) {
    forNamedParts(*apart, procedure, [&](const std::string& key, const auto& parts) {
      const double most = mostApartMetres(procedure);
      const double metres = apart->number(key);
      if (!(std::abs(metres) <= most)) {
        throw apart->error(key, fmt::format("found {:g} metres", metres),
                           fmt::format("at most {:.2g} m, three times the machine's size", most));
      }
      for (const std::size_t part : parts) step.apart.emplace_back(part, metres);
    });
  }
}

std::optional<Torque> readStepTorque(const TomlTable& table) {
  static const std::string kAllowed =
      "such as \"25 Nm\" or \"25 ± 2 Nm\"; units: " + config::listText(torqueUnits());
  const auto text = table.optionalString("torque", kAllowed);
  if (!text) return std::nullopt;
  TorqueReading reading = readTorque(*text);
  if (!reading.torque)
    throw table.error("torque", config::quoted(*text) + " " + reading.problem, kAllowed);
  return reading.torque;
}

void readValueCheck(const TomlTable& table, Check& check) {
  const std::vector<std::string> units(valueUnits().begin(), valueUnits().end());
  check.unit = units[table.choice("unit", units)];
  check.min = table.optionalNumber("min");
  check.max = table.optionalNumber("max");
  if (!check.min && !check.max) throw table.error("min", "missing", "min, max, or both");
  if (check.min && check.max && *check.min >= *check.max) {
    throw table.error(
        "min", fmt::format("found {:g}, which is not below max = {:g}", *check.min, *check.max),
        *check.min > *check.max ? fmt::format("min = {:g}, max = {:g}", *check.max, *check.min)
                                : "a min below max, such as the value less its tolerance");
  }
}

std::optional<Check> readCheck(const TomlTable& step) {
  static constexpr std::array<config::Choice<CheckKind>, 4> kKinds{
      {{"yes_no", CheckKind::kYesNo},
       {"value", CheckKind::kValue},
       {"photo", CheckKind::kPhoto},
       {"compare", CheckKind::kCompare}}};
  Check check;
  if (step.isString("check")) {  // the short form of a check without keys
    check.kind = step.choice("check", kKinds);
    if (check.kind == CheckKind::kValue) {
      throw step.error("check", "\"value\" needs its unit and limits",
                       "{ kind = \"value\", unit = \"mm\", min = 0.1, max = 0.3 }");
    }
    if (check.kind == CheckKind::kCompare) {
      throw step.error("check", "\"compare\" needs its template",
                       "{ kind = \"compare\", template = \"right.png\" }");
    }
    return check;
  }
  const std::optional<TomlTable> given = step.optionalTable("check");
  if (!given) return std::nullopt;
  const TomlTable& table = *given;
  check.kind = table.choice("kind", kKinds);
  if (check.kind == CheckKind::kValue) readValueCheck(table, check);
  if (check.kind == CheckKind::kCompare) check.comparison = table.string("template", "a picture");
  table.finish();
  return check;
}

std::size_t targetOf(const TomlTable& table, std::string_view key, const Procedure& procedure) {
  const std::string name = table.string(key, "the id of a step, or \"end\"");
  if (name == kEndName) return kEnd;
  const auto found = procedure.findStep(name);
  if (found && !name.empty()) return *found;
  std::vector<std::string> ids;
  for (const Step& step : procedure.steps) {
    if (!step.id.empty()) ids.push_back(step.id);  // empty: a mistake of its own
  }
  ids.emplace_back(kEndName);
  throw table.error(key, "there is no step " + config::foundText(name, ids), shortListText(ids));
}

void readNext(const TomlTable& table, const Procedure& procedure, std::size_t index, Step& step) {
  const std::vector<Outcome> outcomes = outcomesOf(step.checkKind());
  std::size_t next = index + 1 < procedure.steps.size() ? index + 1 : kEnd;
  if (table.optionalString("next")) next = targetOf(table, "next", procedure);
  step.next[outcomes.front()] = next;
  const std::optional<TomlTable> given = table.optionalTable("goto");
  if (!given) return;
  const TomlTable& branches = *given;
  if (!step.check)
    throw table.error("goto", "needs a check, whose outcome decides", "next, or a check");
  for (const std::string& key : branches.keys()) {
    const auto outcome =
        std::ranges::find(outcomes, key, [](Outcome each) { return nameOf(each); });
    if (outcome == outcomes.end()) {
      std::vector<std::string> names;
      for (const Outcome each : outcomes) names.emplace_back(nameOf(each));
      throw branches.error(key, config::unknownText("outcome", key, names),
                           config::listText(names));
    }
    if (*outcome == outcomes.front() && table.has("next")) {
      throw branches.error(key, "contradicts next", "one of them");
    }
    step.next[*outcome] = targetOf(branches, key, procedure);
  }
}

bool isIdentifier(std::string_view text) {
  return !text.empty() && text.size() <= 64 && std::ranges::all_of(text, [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_' || c == '-';
  });
}

}  // namespace

Step readStepId(const TomlTable& table, const Procedure& procedure) {
  static constexpr std::string_view kAllowed =
      "lower-case letters, digits, _ and -, such as \"drain_oil\"";
  Step step{.id = table.string("id", kAllowed), .line = table.lineOf("id")};
  if (!isIdentifier(step.id)) {
    throw table.error("id", "found " + config::quoted(step.id), std::string(kAllowed));
  }
  if (step.id == kEndName) throw table.error("id", "\"end\" is reserved", "another id");
  if (const auto earlier = procedure.findStep(step.id)) {
    throw table.error("id",
                      fmt::format("\"{}\" is the step at line {} already", step.id,
                                  procedure.steps[*earlier].line),
                      "unique ids");
  }
  return step;
}

StepReading readStep(const TomlTable& table, Procedure& procedure, std::size_t index,
                     std::vector<config::ConfigError>& faults) {
  StepReading reading;
  Step& step = procedure.steps[index];
  const auto tryTo = [&](const auto& action) {
    try {
      action();
      return true;
    } catch (const config::ConfigError& error) {
      faults.push_back(error);
      return false;
    }
  };
  for (auto& [key, parts] : {std::pair("parts", &step.parts), std::pair("removes", &step.removes),
                             std::pair("fits", &step.fits)}) {
    const bool isKnown = tryTo([&] { *parts = readParts(table, key, procedure); });
    reading.arePartsKnown = reading.arePartsKnown && isKnown;
  }
  tryTo([&] { step.tools = readReferences(table, "tools", procedure.tools); });
  tryTo([&] { step.warnings = readReferences(table, "warnings", procedure.warnings); });
  tryTo([&] { readViews(table, procedure, step); });
  tryTo([&] { step.torque = readStepTorque(table); });
  tryTo([&] {
    if (auto file = table.optionalString("movie", "a movie in the folder")) {
      step.movie = StepMovie{.file = *std::move(file), .size = {}};
    }
  });
  reading.isCheckKnown = tryTo([&] { step.check = readCheck(table); });
  reading.isWayKnown =
      reading.isCheckKnown && tryTo([&] { readNext(table, procedure, index, step); });
  // Without parts of its own, a step shows what it moves.
  if (!table.has("parts")) {
    std::ranges::set_union(step.removes, step.fits, std::back_inserter(step.parts));
  }
  return reading;
}

std::vector<config::ConfigError> unknownStepKeys(const TomlTable& table) {
  static const std::vector<std::string> kKeys{"apart",   "axis",   "check", "fits",   "goto",
                                              "id",      "motion", "movie", "next",   "parts",
                                              "removes", "show",   "tools", "torque", "warnings"};
  return unknownKeys(table, kKeys);
}

}  // namespace pleinair::procedure
