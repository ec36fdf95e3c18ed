#include "config/parameter_values.h"

#include <cassert>
#include <utility>

#include <fmt/format.h>

#include "config/suggestion.h"

namespace pleinair::config {
namespace {

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
  }
  return std::nullopt;
}

}  // namespace

ParameterValues::ParameterValues(std::shared_ptr<const ParameterList> list) {
  auto data = std::make_shared<Data>();
  for (const ParameterDescriptor& each : list->descriptors()) {
    data->values.push_back(each.defaultValue);
    data->origins.emplace_back("default");
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
                       .found = quoted(std::string(text)),
                       .allowed = descriptor.allowed()});
  }
  return with(index, *value, std::move(origin));
}

ParameterValues ParameterValues::with(std::size_t index, ParameterValue value,
                                      std::string origin) const {
  assert(list().descriptors()[index].allows(value));
  auto data = std::make_shared<Data>(*data_);
  data->values[index] = value;
  data->origins[index] = std::move(origin);
  ParameterValues changed = *this;
  changed.data_ = std::move(data);
  return changed;
}

ParameterValues ParameterValues::with(const TomlTable& table) const {
  auto data = std::make_shared<Data>(*data_);
  for (std::size_t i = 0; i < data->values.size(); ++i) {
    const ParameterDescriptor& descriptor = list().descriptors()[i];
    const std::optional<ParameterValue> value = read(table, descriptor);
    if (!value) continue;
    data->values[i] = *value;
    data->origins[i] = fmt::format("{}:{}", table.file(), table.lineOf(descriptor.name));
  }
  table.finish();
  ParameterValues changed = *this;
  changed.data_ = std::move(data);
  return changed;
}

std::string ParameterValues::toToml() const {
  std::string toml;
  for (std::size_t i = 0; i < data_->values.size(); ++i) {
    const ParameterDescriptor& each = list().descriptors()[i];
    const std::string_view quote = each.kind() == ParameterKind::kChoice ? "\"" : "";
    if (i > 0) toml += '\n';
    toml += fmt::format("# {}\n# {}; default: {}; {}\n{} = {}{}{}\n", each.help, each.allowed(),
                        each.textOf(each.defaultValue),
                        each.takesEffect == TakesEffect::kLive ? "live" : "at the next start",
                        each.name, quote, each.textOf(at(i)), quote);
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
