#include "config/parameter.h"

#include <algorithm>
#include <cassert>
#include <cctype>
#include <charconv>
#include <iterator>
#include <system_error>
#include <utility>

#include <fmt/format.h>

#include "config/config_error.h"
#include "config/suggestion.h"
#include "config/toml_text.h"

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

constexpr std::size_t kMaxTextLength = 255;
constexpr std::size_t kMaxPathLength = 4096;

bool isAmong(const std::vector<std::string>& words, std::string_view text) {
  return std::find(words.begin(), words.end(), text) != words.end();
}

std::optional<PixelSize> parsedSize(std::string_view text) {
  const std::size_t cross = text.find('x');
  if (cross == std::string_view::npos) return std::nullopt;
  const auto width = wholeTextAs<int>(text.substr(0, cross));
  const auto height = wholeTextAs<int>(text.substr(cross + 1));
  if (!width || !height) return std::nullopt;
  return PixelSize{*width, *height};
}

bool hasControlCharacter(std::string_view text) {
  return std::any_of(text.begin(), text.end(),
                     [](char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7F; });
}

/// Whether the text begins with "serial:", if "serial:NUMBER" is among the choices.
bool isAmongOpen(const std::vector<std::string>& openChoices, std::string_view text) {
  return std::any_of(openChoices.begin(), openChoices.end(), [&](const std::string& choice) {
    const std::string_view word = std::string_view(choice).substr(0, choice.find(':') + 1);
    return text.starts_with(word) && text.size() > word.size();
  });
}

/// Files of cameras and of other systems end in ".PNG". `ending` is in lower case.
bool endsWith(std::string_view path, std::string_view ending) {
  if (path.size() < ending.size()) return false;
  return std::ranges::equal(path.substr(path.size() - ending.size()), ending, {}, [](char c) {
    return static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  });
}

bool isAllowedPath(const ParameterDescriptor& descriptor, const std::string& path) {
  const auto& words = descriptor.choices;
  const bool isPlain = path.size() <= kMaxPathLength && path.find('\0') == std::string::npos;
  if (isAmong(words, path)) return true;
  if (isAmongOpen(descriptor.openChoices, path)) return isPlain;
  const bool continuesWord = std::any_of(
      words.begin(), words.end(), [&](const auto& word) { return path.starts_with(word + ':'); });
  return !continuesWord && !path.empty() && isPlain && endsWith(path, descriptor.pathEnding);
}

std::string allowedPaths(const ParameterDescriptor& descriptor) {
  const std::string path =
      descriptor.pathEnding.empty() ? "a path" : "a path that ends in " + descriptor.pathEnding;
  std::vector<std::string> words = descriptor.choices;
  words.insert(words.end(), descriptor.openChoices.begin(), descriptor.openChoices.end());
  return words.empty() ? path : listText(words) + ", or " + path;
}

std::string allowedElements(const ParameterDescriptor& descriptor) {
  std::vector<std::string> words = descriptor.choices;
  words.insert(words.end(), descriptor.openChoices.begin(), descriptor.openChoices.end());
  const std::string path = descriptor.textAllowed.empty() ? "a path" : descriptor.textAllowed;
  return words.empty() ? path : listText(words) + ", or " + path;
}

/// "an array of 1 to 8 of: window, loopback:DEVICE, or a path"
std::string allowedLists(const ParameterDescriptor& descriptor) {
  return descriptor.lengthRange.describe("texts") + ", each " + allowedElements(descriptor);
}

bool isAllowedList(const ParameterDescriptor& descriptor,
                   const std::vector<std::filesystem::path>& list) {
  return descriptor.lengthRange.contains(list.size()) &&
         std::all_of(list.begin(), list.end(), [&](const std::filesystem::path& each) {
           return descriptor.allowsElement(each.string());
         });
}

/// The elements of a list's text; nothing where a backslash is before anything but a comma or
/// another.
std::optional<std::vector<std::filesystem::path>> parsedList(std::string_view text) {
  std::vector<std::filesystem::path> list;
  std::string element;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] == ',') {
      list.emplace_back(std::exchange(element, {}));
      continue;
    }
    if (text[i] == '\\' && (++i == text.size() || (text[i] != ',' && text[i] != '\\'))) {
      return std::nullopt;
    }
    element += text[i];
  }
  list.emplace_back(element);
  return list;
}

std::string allowedSizes(const ParameterDescriptor& descriptor) {
  const std::string sizes = descriptor.sizeRange.describe();
  return descriptor.choices.empty() ? sizes : descriptor.choices.front() + ", or " + sizes;
}

std::optional<ParameterValue> parsedAs(const ParameterDescriptor& descriptor,
                                       std::string_view text) {
  switch (descriptor.kind()) {
    case ParameterKind::kNumber:
      return wholeTextAs<double>(text);
    case ParameterKind::kInteger:
      return wholeTextAs<int>(text);
    case ParameterKind::kSwitch:
      if (text == "true" || text == "on") return true;
      if (text == "false" || text == "off") return false;
      return std::nullopt;
    case ParameterKind::kChoice: {
      const auto& choices = descriptor.choices;
      const auto found = std::find(choices.begin(), choices.end(), text);
      if (found == choices.end()) return std::nullopt;
      return ChoiceIndex{static_cast<std::size_t>(found - choices.begin())};
    }
    case ParameterKind::kText:
      return std::string(text);
    case ParameterKind::kPath:
      return std::filesystem::path(text);
    case ParameterKind::kSize:
      // "0x0" is written as its word.
      if (isAmong(descriptor.choices, text)) return PixelSize{};
      if (const auto size = parsedSize(text); size && *size != PixelSize{}) return *size;
      return std::nullopt;
    case ParameterKind::kPathList:
      if (auto list = parsedList(text)) return *std::move(list);
      return std::nullopt;
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

std::string textOfPaths(const std::vector<std::filesystem::path>& paths) {
  std::string text;
  for (const std::filesystem::path& each : paths) {
    if (!text.empty()) text += ',';
    for (const char c : each.string()) {
      if (c == ',' || c == '\\') text += '\\';
      text += c;
    }
  }
  return text;
}

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
    case ParameterKind::kText:
      if (!textAllowed.empty()) return textAllowed;
      return fmt::format("a text of 1 to {} bytes on one line", kMaxTextLength);
    case ParameterKind::kPath:
      return allowedPaths(*this);
    case ParameterKind::kSize:
      return allowedSizes(*this);
    case ParameterKind::kPathList:
      return allowedLists(*this);
  }
  return {};
}

bool ParameterDescriptor::allows(const ParameterValue& value) const {
  if (value.index() != defaultValue.index()) return false;
  if (const auto* number = std::get_if<double>(&value)) return numberRange.contains(*number);
  if (const auto* integer = std::get_if<int>(&value)) return integerRange.contains(*integer);
  if (const auto* choice = std::get_if<ChoiceIndex>(&value)) return choice->index < choices.size();
  if (const auto* text = std::get_if<std::string>(&value)) {
    const bool isText =
        !text->empty() && text->size() <= kMaxTextLength && !hasControlCharacter(*text);
    return isText && (!takesText || takesText(*text));
  }
  if (const auto* path = std::get_if<std::filesystem::path>(&value)) {
    return isAllowedPath(*this, path->string());
  }
  if (const auto* size = std::get_if<PixelSize>(&value)) {
    return sizeRange.contains(*size) || (*size == PixelSize{} && !choices.empty());
  }
  if (const auto* list = std::get_if<std::vector<std::filesystem::path>>(&value)) {
    return isAllowedList(*this, *list);
  }
  return true;
}

bool ParameterDescriptor::allowsElement(const std::string& text) const {
  return isAllowedPath(*this, text) && (!takesText || takesText(text));
}

bool ParameterDescriptor::isPath(std::string_view text) const {
  return !isAmong(choices, text) && !isAmongOpen(openChoices, text);
}

std::string ParameterDescriptor::textOf(const ParameterValue& value) const {
  if (const auto* number = std::get_if<double>(&value)) return fmt::format("{}", *number);
  if (const auto* integer = std::get_if<int>(&value)) return fmt::format("{}", *integer);
  if (const auto* choice = std::get_if<ChoiceIndex>(&value)) return choices.at(choice->index);
  if (const auto* text = std::get_if<std::string>(&value)) return *text;
  if (const auto* path = std::get_if<std::filesystem::path>(&value)) return path->string();
  if (const auto* size = std::get_if<PixelSize>(&value)) {
    const bool isWord = *size == PixelSize{} && !choices.empty();
    return isWord ? choices.front() : fmt::format("{}x{}", size->width, size->height);
  }
  if (const auto* list = std::get_if<std::vector<std::filesystem::path>>(&value)) {
    return textOfPaths(*list);
  }
  return std::get<bool>(value) ? "true" : "false";
}

std::optional<ParameterValue> ParameterDescriptor::parse(std::string_view text) const {
  std::optional<ParameterValue> value = parsedAs(*this, text);
  if (value && !allows(*value)) return std::nullopt;
  return value;
}

std::string ParameterDescriptor::tomlOf(const ParameterValue& value) const {
  if (kind() < ParameterKind::kChoice) return textOf(value);
  if (const auto* list = std::get_if<std::vector<std::filesystem::path>>(&value)) {
    std::string toml;
    for (const std::filesystem::path& each : *list) {
      if (!toml.empty()) toml += ", ";
      toml += tomlOfText(each.string());
    }
    return "[" + toml + "]";
  }
  return tomlOfText(textOf(value));
}

std::string ParameterDescriptor::tomlOfText(std::string text) const {
  const bool mayBePath = kind() == ParameterKind::kPath || kind() == ParameterKind::kPathList;
  if (mayBePath && isPath(text)) {
    std::error_code failure;
    const std::filesystem::path absolute = std::filesystem::absolute(text, failure);
    if (!failure) text = absolute.lexically_normal().string();
  }
  const std::optional<std::string> toml = tomlString(text);
  if (!toml) {
    throw ConfigError(
        {.key = name, .found = config::quoted(text), .allowed = "UTF-8, to be put into TOML"});
  }
  return *toml;
}

std::string ParameterDescriptor::allowedInsteadOf(std::string_view text) const {
  const std::size_t colon = text.find(':');
  const bool mayBePath = kind() == ParameterKind::kPath || kind() == ParameterKind::kPathList;
  if (!mayBePath || colon == std::string_view::npos) return allowed();
  std::vector<std::string> words;
  for (const std::vector<std::string>* each : {&choices, &openChoices}) {
    std::copy_if(each->begin(), each->end(), std::back_inserter(words), [&](const auto& word) {
      return word == text.substr(0, colon) || word.starts_with(text.substr(0, colon + 1));
    });
  }
  const bool goesOn = std::any_of(words.begin(), words.end(), [](const std::string& word) {
    return word.find(':') != std::string::npos;
  });
  return goesOn ? listText(words) : allowed();
}

std::string ParameterDescriptor::foundIn(std::string_view text) const {
  return foundText(text, choices);
}

ParameterList::ParameterList(std::vector<ParameterDescriptor> descriptors)
    : descriptors_(std::move(descriptors)) {
  for (std::size_t i = 0; i < descriptors_.size(); ++i) {
    [[maybe_unused]] const ParameterDescriptor& each = descriptors_[i];
    assert(isBareName(each.name) && indexOf(each.name) == i);
    assert(each.kind() == ParameterKind::kPath || each.kind() == ParameterKind::kPathList ||
           std::all_of(each.choices.begin(), each.choices.end(), isBareName));
    assert(each.kind() != ParameterKind::kSize || each.choices.size() <= 1);
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
