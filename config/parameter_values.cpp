#include "config/parameter_values.h"

#include <algorithm>
#include <cassert>
#include <utility>

#include <fmt/format.h>

#include "config/suggestion.h"
#include "config/toml_text.h"

namespace pleinair::config {
namespace {

/// Resolves a relative path against the directory of its file.
ParameterValue resolved(ParameterValue value, const ParameterDescriptor& descriptor,
                        const std::filesystem::path& directory) {
  auto* path = std::get_if<std::filesystem::path>(&value);
  if (path == nullptr) return value;
  if (descriptor.isPath(path->string())) *path = directory / *path;  // an absolute path stays
  return value;
}

/// Reads a value that is a string in TOML.
std::optional<ParameterValue> readText(const TomlTable& table,
                                       const ParameterDescriptor& descriptor) {
  const auto text = table.optionalString(descriptor.name, descriptor.allowed());
  if (!text) return std::nullopt;
  std::optional<ParameterValue> value = descriptor.parse(*text);
  if (!value) {
    throw table.error(descriptor.name, "found " + descriptor.foundIn(*text),
                      descriptor.allowedInsteadOf(*text));
  }
  return resolved(std::move(*value), descriptor, table.directory());
}

std::optional<ParameterValue> readList(const TomlTable& table,
                                       const ParameterDescriptor& descriptor) {
  const auto texts =
      table.optionalStrings(descriptor.name, descriptor.lengthRange, descriptor.allowed());
  if (!texts) return std::nullopt;
  std::vector<std::filesystem::path> list;
  for (const std::string& text : *texts) {
    if (!descriptor.allowsElement(text)) {
      throw table.error(descriptor.name, "found " + descriptor.foundIn(text),
                        descriptor.allowedInsteadOf(text));
    }
    // An absolute path stays.
    list.push_back(descriptor.isPath(text) ? table.directory() / text
                                           : std::filesystem::path(text));
  }
  return list;
}

std::optional<ParameterValue> read(const TomlTable& table, const ParameterDescriptor& descriptor) {
  const std::string& name = descriptor.name;
  switch (descriptor.kind()) {
    case ParameterKind::kNumber:
      return table.optionalNumber(name, descriptor.numberRange);
    case ParameterKind::kInteger:
      return table.optionalInteger(name, descriptor.integerRange);
    case ParameterKind::kSwitch:
      return table.optionalBoolean(name);
    case ParameterKind::kChoice:
      if (const auto index = table.optionalChoice(name, descriptor.choices)) {
        return ChoiceIndex{*index};
      }
      return std::nullopt;
    case ParameterKind::kText:
    case ParameterKind::kPath:
    case ParameterKind::kSize:
      return readText(table, descriptor);
    case ParameterKind::kPathList:
      return readList(table, descriptor);
  }
  return std::nullopt;
}

}  // namespace

ParameterValues::ParameterValues(std::shared_ptr<const ParameterList> list) {
  auto data = std::make_shared<Data>();
  for (const ParameterDescriptor& each : list->descriptors()) {
    data->values.push_back(each.defaultValue);
    data->origins.emplace_back(kDefaultOrigin);
  }
  data->list = std::move(list);
  data_ = std::move(data);
}

std::size_t ParameterValues::indexOf(std::string_view name, const std::string& origin) const {
  const std::optional<std::size_t> index = list().indexOf(name);
  if (index) return *index;
  const std::vector<std::string> names = list().names();
  throw ConfigError({.file = origin,
                     .key = std::string(name),
                     .problem = unknownText("parameter", name, names),
                     .allowed = listText(names)});
}

std::string ParameterValues::text(std::string_view name) const {
  const std::size_t index = indexOf(name, {});
  return list().descriptors()[index].textOf(at(index));
}

const std::string& ParameterValues::origin(std::string_view name) const {
  return data_->origins[indexOf(name, {})];
}

ParameterValues ParameterValues::with(std::string_view name, std::string_view text,
                                      std::string origin) const {
  const std::size_t index = indexOf(name, origin);
  const ParameterDescriptor& descriptor = list().descriptors()[index];
  std::optional<ParameterValue> value = descriptor.parse(text);
  if (!value) {
    throw ConfigError({.file = std::move(origin),
                       .key = std::string(name),
                       .found = descriptor.foundIn(text),
                       .allowed = descriptor.allowedInsteadOf(text)});
  }
  return with(index, std::move(*value), std::move(origin));
}

ParameterValues ParameterValues::with(std::size_t index, ParameterValue value,
                                      std::string origin) const {
  assert(list().descriptors()[index].allows(value));
  auto data = std::make_shared<Data>(*data_);
  data->values[index] = std::move(value);
  data->origins[index] = std::move(origin);
  ParameterValues changed = *this;
  changed.data_ = std::move(data);
  return changed;
}

ParameterValues ParameterValues::with(const TomlTable& table) const {
  ParameterValues changed = withKnownKeys(table);
  table.finish();
  return changed;
}

ParameterValues ParameterValues::withKnownKeys(const TomlTable& table) const {
  auto data = std::make_shared<Data>(*data_);
  for (std::size_t i = 0; i < data->values.size(); ++i) {
    const ParameterDescriptor& descriptor = list().descriptors()[i];
    std::optional<ParameterValue> value = read(table, descriptor);
    if (!value) continue;
    data->values[i] = std::move(*value);
    data->origins[i] = fmt::format("{}:{}", table.file(), table.lineOf(descriptor.name));
  }
  ParameterValues changed = *this;
  changed.data_ = std::move(data);
  return changed;
}

std::string ParameterValues::toToml(Printed which) const {
  std::string toml;
  for (std::size_t i = 0; i < data_->values.size(); ++i) {
    const ParameterDescriptor& each = list().descriptors()[i];
    if (which == Printed::kGiven && data_->origins[i] == kDefaultOrigin) continue;
    if (!toml.empty()) toml += '\n';
    toml += fmt::format("# {}\n# {}; default: {}; {}\n{} = {}  # {}\n", each.help, each.allowed(),
                        each.textOf(each.defaultValue),
                        each.takesEffect == TakesEffect::kLive ? "live" : "at the next start",
                        each.name, each.tomlOf(at(i)), tomlComment(data_->origins[i]));
  }
  return toml;
}

bool ParameterValues::operator==(const ParameterValues& other) const {
  return data_->list == other.data_->list && data_->values == other.data_->values;
}

bool ParameterValues::needsRestartFor(const ParameterValues& next) const {
  assert(data_->list == next.data_->list);
  for (std::size_t i = 0; i < data_->values.size(); ++i) {
    const bool restart = list().descriptors()[i].takesEffect == TakesEffect::kRestart;
    if (restart && at(i) != next.at(i)) return true;
  }
  return false;
}

}  // namespace pleinair::config
