#include "config/parameter.h"

#include <algorithm>
#include <cassert>
#include <charconv>
#include <system_error>
#include <utility>

#include <fmt/format.h>

#include "config/suggestion.h"

namespace pleinair::config {
namespace {

template <class T>
std::optional<T> wholeTextAs(std::string_view text) {
  T value{};
  const char* end = text.data() + text.size();
  const auto [stop, failure] = std::from_chars(text.data(), end, value);
  if (failure != std::errc() || stop != end) return std::nullopt;
  return value;
}

std::optional<ParameterValue> parsedAs(const ParameterDescriptor& descriptor,
                                       std::string_view text) {
  switch (descriptor.kind()) {
    case ParameterKind::kNumber:
      return wholeTextAs<double>(text);
    case ParameterKind::kInteger:
      return wholeTextAs<int>(text);
    case ParameterKind::kSwitch:
      if (text == "true") return true;
      if (text == "false") return false;
      return std::nullopt;
    case ParameterKind::kChoice: {
      const auto& choices = descriptor.choices;
      const auto found = std::find(choices.begin(), choices.end(), text);
      if (found == choices.end()) return std::nullopt;
      return ChoiceIndex{static_cast<std::size_t>(found - choices.begin())};
    }
  }
  return std::nullopt;
}

[[maybe_unused]] bool isBareName(std::string_view name) {
  const auto isBare = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_' || c == '-';
  };
  return !name.empty() && std::all_of(name.begin(), name.end(), isBare);
}

}  // namespace

std::string_view ParameterDescriptor::unit() const {
  if (kind() == ParameterKind::kNumber) return numberRange.unit;
  if (kind() == ParameterKind::kInteger) return integerRange.unit;
  return {};
}

std::string ParameterDescriptor::allowed() const {
  switch (kind()) {
    case ParameterKind::kNumber:
      return numberRange.describe();
    case ParameterKind::kInteger:
      return integerRange.describe();
    case ParameterKind::kSwitch:
      return "true or false";
    case ParameterKind::kChoice:
      return "one of " + listText(choices);
  }
  return {};
}

bool ParameterDescriptor::allows(const ParameterValue& value) const {
  if (value.index() != defaultValue.index()) return false;
  if (const auto* number = std::get_if<double>(&value)) return numberRange.contains(*number);
  if (const auto* integer = std::get_if<int>(&value)) return integerRange.contains(*integer);
  if (const auto* choice = std::get_if<ChoiceIndex>(&value)) return choice->index < choices.size();
  return true;
}

std::string ParameterDescriptor::textOf(const ParameterValue& value) const {
  if (const auto* number = std::get_if<double>(&value)) return fmt::format("{}", *number);
  if (const auto* integer = std::get_if<int>(&value)) return fmt::format("{}", *integer);
  if (const auto* choice = std::get_if<ChoiceIndex>(&value)) return choices.at(choice->index);
  return std::get<bool>(value) ? "true" : "false";
}

std::optional<ParameterValue> ParameterDescriptor::parse(std::string_view text) const {
  std::optional<ParameterValue> value = parsedAs(*this, text);
  if (value && !allows(*value)) return std::nullopt;
  return value;
}

ParameterList::ParameterList(std::vector<ParameterDescriptor> descriptors)
    : descriptors_(std::move(descriptors)) {
  for (std::size_t i = 0; i < descriptors_.size(); ++i) {
    [[maybe_unused]] const ParameterDescriptor& each = descriptors_[i];
    assert(isBareName(each.name) && indexOf(each.name) == i);
    assert(std::all_of(each.choices.begin(), each.choices.end(), isBareName));
    assert(each.help.find('\n') == std::string::npos);
    assert(each.allows(each.defaultValue));
  }
}

std::optional<std::size_t> ParameterList::indexOf(std::string_view name) const {
  for (std::size_t i = 0; i < descriptors_.size(); ++i) {
    if (descriptors_[i].name == name) return i;
  }
  return std::nullopt;
}

std::vector<std::string> ParameterList::names() const {
  std::vector<std::string> names;
  for (const ParameterDescriptor& each : descriptors_) names.push_back(each.name);
  return names;
}

}  // namespace pleinair::config
