#include "config/sections.h"

#include <algorithm>
#include <cassert>
#include <charconv>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "config/suggestion.h"

namespace pleinair::config {
namespace {

/// "STYLE_WATERCOLOR" for "style.watercolor".
std::string asVariable(std::string_view name) {
  std::string variable(name);
  for (char& c : variable) {
    if (c >= 'a' && c <= 'z') c = static_cast<char>(c - 'a' + 'A');
    if (c == '.' || c == '-') c = '_';
  }
  return variable;
}

std::string joined(std::string_view section, std::string_view key) {
  return section.empty() ? std::string(key) : fmt::format("{}.{}", section, key);
}

/// The table at a dotted path; nothing if it, or a table above it, is missing.
std::optional<TomlTable> tableAt(const TomlTable& root, std::string_view path) {
  std::optional<TomlTable> table = root;
  while (table && !path.empty()) {
    const std::size_t dot = std::min(path.find('.'), path.size());
    table = table->optionalTable(path.substr(0, dot));
    path.remove_prefix(std::min(dot + 1, path.size()));
  }
  return table;
}

/// The paths of a section and of all tables above it: "", "style" and "style.watercolor".
std::vector<std::string> pathsTo(std::string_view section) {
  std::vector<std::string> paths{""};
  if (section.empty()) return paths;
  for (std::size_t dot = section.find('.'); dot != std::string_view::npos;
       dot = section.find('.', dot + 1)) {
    paths.emplace_back(section.substr(0, dot));
  }
  paths.emplace_back(section);
  return paths;
}

/// Splits "site.toml:7" into file and line; other origins have no line.
void attribute(const std::string& origin, ConfigFault& fault) {
  const std::size_t colon = origin.rfind(':');
  int line = 0;
  if (colon != std::string::npos) {
    const char* const end = origin.data() + origin.size();
    const auto [stop, failure] = std::from_chars(origin.data() + colon + 1, end, line);
    if (failure != std::errc() || stop != end) line = 0;
  }
  fault.file = line > 0 ? origin.substr(0, colon) : origin;
  fault.line = line;
}

}  // namespace

Sections::Sections(std::vector<Section> sections, std::string prefix,
                   std::span<const RenamedKey> renamed)
    : sections_(std::move(sections)), prefix_(std::move(prefix)), renamed_(renamed) {
  std::vector<std::string> variables;
  for (const Section& section : sections_) {
    for (const std::string& name : section.values.list().names()) {
      variables.push_back(variableOf(section, name));
    }
  }
  std::sort(variables.begin(), variables.end());
  assert(std::adjacent_find(variables.begin(), variables.end()) == variables.end());
  assert(std::all_of(renamed_.begin(), renamed_.end(),
                     [&](const RenamedKey& each) { return !find(each.old) && find(each.now); }));
}

const ParameterValues& Sections::values(std::string_view section) const {
  const auto found = std::find_if(sections_.begin(), sections_.end(),
                                  [&](const Section& each) { return each.name == section; });
  assert(found != sections_.end());
  return found->values;
}

void Sections::setValues(std::string_view section, ParameterValues values) {
  for (Section& each : sections_) {
    if (each.name != section) continue;
    assert(&each.values.list() == &values.list());
    each.values = std::move(values);
    return;
  }
  assert(false);
}

std::optional<Sections::Key> Sections::find(std::string_view key) const {
  for (std::size_t s = 0; s < sections_.size(); ++s) {
    const std::vector<std::string> names = sections_[s].values.list().names();
    for (std::size_t p = 0; p < names.size(); ++p) {
      if (joined(sections_[s].name, names[p]) == key) return Key{s, p};
    }
  }
  return std::nullopt;
}

std::optional<Sections::Key> Sections::findVariable(std::string_view variable) const {
  for (std::size_t s = 0; s < sections_.size(); ++s) {
    const std::vector<std::string> names = sections_[s].values.list().names();
    for (std::size_t p = 0; p < names.size(); ++p) {
      if (variableOf(sections_[s], names[p]) == variable) return Key{s, p};
    }
  }
  return std::nullopt;
}

std::string Sections::variableOf(const Section& section, std::string_view parameter) const {
  return prefix_ + asVariable(joined(section.name, parameter));
}

const RenamedKey* Sections::renamedKey(std::string_view key) const {
  const auto found = std::find_if(renamed_.begin(), renamed_.end(),
                                  [&](const RenamedKey& each) { return each.old == key; });
  return found == renamed_.end() ? nullptr : &*found;
}

/// The keys that a table may have: its parameters and its subtables.
std::vector<std::string> Sections::keysIn(std::string_view table) const {
  std::vector<std::string> keys;
  for (const Section& section : sections_) {
    if (section.name == table) {
      for (const std::string& name : section.values.list().names()) keys.push_back(name);
    } else if (table.empty() || section.name.starts_with(fmt::format("{}.", table))) {
      const std::string_view rest =
          std::string_view(section.name).substr(table.empty() ? 0 : table.size() + 1);
      std::string within(rest.substr(0, rest.find('.')));
      if (std::find(keys.begin(), keys.end(), within) == keys.end()) {
        keys.push_back(std::move(within));
      }
    }
  }
  std::sort(keys.begin(), keys.end());
  return keys;
}

std::string Sections::problemOf(std::string_view unknownKey,
                                std::span<const std::string> known) const {
  if (nearest(unknownKey, known)) return unknownText("key", unknownKey, known);
  for (const Section& section : sections_) {
    if (!section.values.list().indexOf(unknownKey)) continue;
    return section.name.empty() ? "unknown key (it belongs before all tables)"
                                : fmt::format("unknown key (it belongs to [{}])", section.name);
  }
  return "unknown key";
}

void Sections::refuseUnknownKeys(const TomlTable& table, const std::string& name) const {
  const std::vector<std::string> known = keysIn(name);
  std::optional<std::string> first;
  for (const std::string& key : table.keys()) {
    if (std::find(known.begin(), known.end(), key) != known.end()) continue;
    if (!first || table.lineOf(key) < table.lineOf(*first)) first = key;
  }
  if (!first) return;
  if (const RenamedKey* renamed = renamedKey(joined(name, *first))) {
    throw table.error(*first, fmt::format("is now {}", renamed->now), {});
  }
  throw table.error(*first, problemOf(*first, known), listText(known));
}

void Sections::apply(const TomlDocument& document) {
  const TomlTable& root = document.root();
  std::vector<std::string> done;
  for (const Section& section : sections_) {
    for (const std::string& path : pathsTo(section.name)) {
      if (std::find(done.begin(), done.end(), path) != done.end()) continue;
      done.push_back(path);
      if (const auto table = tableAt(root, path)) refuseUnknownKeys(*table, path);
    }
  }
  std::vector<Section> changed = sections_;
  for (Section& section : changed) {
    const auto table = tableAt(root, section.name);
    if (table) section.values = section.values.withKnownKeys(*table);
  }
  sections_ = std::move(changed);
}

void Sections::set(const Key& key, std::string_view text, const std::string& origin) {
  Section& section = sections_[key.section];
  const ParameterDescriptor& descriptor = section.values.list().descriptors()[key.parameter];
  std::optional<ParameterValue> value = descriptor.parse(text);
  if (!value) {
    // The origin already names the key.
    throw ConfigError({.file = origin,
                       .found = descriptor.foundIn(text),
                       .allowed = descriptor.allowedInsteadOf(text)});
  }
  section.values = section.values.with(key.parameter, std::move(*value), origin);
}

ConfigError Sections::unknownKey(std::string_view key, const std::string& origin,
                                 std::string_view section) const {
  if (const RenamedKey* renamed = renamedKey(joined(section, key))) {
    return ConfigError({.file = origin, .problem = fmt::format("is now {}", renamed->now)});
  }
  std::vector<std::string> near = keysIn(section);  // to be listed
  std::vector<std::string> all = near;              // to be suggested
  if (section.empty()) near.clear();
  const std::string_view table = key.substr(0, std::min(key.rfind('.'), key.size()));
  const std::string_view name = key.substr(std::min(key.rfind('.') + 1, key.size()));
  std::vector<std::string> tables;
  std::optional<std::string> elsewhere;
  for (const Section& each : sections_) {
    const std::vector<std::string> names = each.values.list().names();
    if (!each.name.empty() && !names.empty()) tables.push_back(each.name + ".…");
    for (const std::string& parameter : names) {
      all.push_back(joined(each.name, parameter));
      if (section.empty() && each.name == table) near.push_back(all.back());
      if (parameter == name && !elsewhere) elsewhere = all.back();
    }
  }
  const bool isSlip = nearest(key, all).has_value();
  return ConfigError(
      {.file = origin,
       .problem = isSlip || !elsewhere
                      ? unknownText("key", key, all)
                      : fmt::format("unknown key (did you mean \"{}\"?)", *elsewhere),
       .allowed = listText(near.empty() ? tables : near)});
}

void Sections::apply(std::string_view key, std::string_view text, const std::string& origin,
                     std::string_view section) {
  const std::optional<Key> found = find(joined(section, key));
  if (!found) throw unknownKey(key, origin, section);
  set(*found, text, origin);
}

ConfigError Sections::unknownVariable(const std::string& name,
                                      std::span<const std::string> others) const {
  for (const RenamedKey& each : renamed_) {
    if (prefix_ + asVariable(each.old) != name) continue;
    return ConfigError(
        {.file = name, .problem = fmt::format("is now {}{}", prefix_, asVariable(each.now))});
  }
  std::vector<std::string> all(others.begin(), others.end());
  std::vector<std::string> near;
  std::vector<std::string> groups(others.begin(), others.end());
  for (const Section& section : sections_) {
    const std::string group = variableOf(section, "");
    for (const std::string& parameter : section.values.list().names()) {
      all.push_back(variableOf(section, parameter));
      if (section.name.empty()) groups.push_back(all.back());
      if (!section.name.empty() && name.starts_with(group)) near.push_back(all.back());
    }
    const bool hasKeys = !section.values.list().descriptors().empty();
    if (!section.name.empty() && hasKeys) groups.push_back(group + "…");
  }
  return ConfigError({.file = name,
                      .problem = unknownText("variable", name, all),
                      .allowed = listText(near.empty() ? groups : near)});
}

void Sections::apply(const EnvironmentVariable& variable, std::span<const std::string> others) {
  const std::optional<Key> found = findVariable(variable.name);
  if (!found) throw unknownVariable(variable.name, others);
  set(*found, variable.value, variable.name);
}

void Sections::forget(std::string_view key) {
  const std::optional<Key> found = find(key);
  assert(found);
  ParameterValues& values = sections_[found->section].values;
  values = values.with(found->parameter, values.list().descriptors()[found->parameter].defaultValue,
                       std::string(kDefaultOrigin));
}

const std::string& Sections::origin(std::string_view key) const {
  const std::optional<Key> found = find(key);
  assert(found);
  const ParameterValues& values = sections_[found->section].values;
  return values.origin(values.list().descriptors()[found->parameter].name);
}

ConfigError Sections::errorAt(std::string_view key, std::string problem,
                              std::string allowed) const {
  ConfigFault fault{.problem = std::move(problem), .allowed = std::move(allowed)};
  attribute(origin(key), fault);
  if (fault.line > 0) fault.key = key;
  return ConfigError(std::move(fault));
}

std::string Sections::toToml(Printed which) const {
  std::string toml;
  for (const Section& section : sections_) {
    const std::string keys = section.values.toToml(which);
    if (keys.empty()) continue;
    if (!toml.empty()) toml += '\n';
    if (!section.help.empty()) toml += fmt::format("# {}\n", section.help);
    if (!section.name.empty()) toml += fmt::format("[{}]\n", section.name);
    toml += keys;
  }
  return toml;
}

}  // namespace pleinair::config
