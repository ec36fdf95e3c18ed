#include "pipeline/procedure/node_names.h"

#include <algorithm>
#include <charconv>
#include <optional>
#include <set>
#include <span>
#include <string_view>
#include <system_error>

#include <fmt/format.h>

#include "config/config_error.h"
#include "config/suggestion.h"

namespace pleinair::procedure {
namespace {

/// Patterns that match some name: "bolt_*" of "bolt_1", "bearing_5_*" of "bearing_5_balls".
std::vector<std::string> patternsOf(std::span<const std::string> names) {
  std::set<std::string> patterns;
  for (const std::string& name : names) {
    for (std::size_t at = name.find('_'); at != std::string::npos; at = name.find('_', at + 1)) {
      patterns.insert(name.substr(0, at + 1) + "*");
    }
  }
  return {patterns.begin(), patterns.end()};
}

/// "piston#2": the second of the parts named "piston".
struct NumberedName {
  std::string_view stem;
  std::size_t number = 0;  ///< from 1
};

std::optional<NumberedName> numberedName(std::string_view name) {
  const std::size_t sign = name.rfind('#');
  if (sign == std::string_view::npos) return std::nullopt;
  std::size_t number = 0;
  const char* const end = name.data() + name.size();
  const auto parsed = std::from_chars(name.data() + sign + 1, end, number);
  if (parsed.ec != std::errc{} || parsed.ptr != end) return std::nullopt;
  return NumberedName{.stem = name.substr(0, sign), .number = number};
}

std::optional<std::size_t> partNumbered(const scene::Model& model, std::string_view name) {
  std::optional<NumberedName> wanted = numberedName(name);
  if (!wanted || wanted->number == 0) return std::nullopt;
  for (std::size_t i = 0; i < model.parts.size(); ++i) {
    if (model.parts[i].name == wanted->stem && --wanted->number == 0) return i;
  }
  return std::nullopt;
}

}  // namespace

std::vector<std::string> nodeNames(const scene::Model& model) {
  std::vector<std::string> names;
  std::set<std::string_view> known;
  for (const scene::ModelPart& part : model.parts) {
    if (known.insert(part.name).second) names.push_back(part.name);
  }
  return names;
}

std::vector<std::size_t> partsNamed(const scene::Model& model, std::string_view name) {
  std::vector<std::size_t> parts;
  const bool isPrefix = name.ends_with('*');
  const std::string_view prefix = name.substr(0, name.size() - (isPrefix ? 1 : 0));
  for (std::size_t i = 0; i < model.parts.size(); ++i) {
    const std::string& each = model.parts[i].name;
    if (isPrefix ? each.starts_with(prefix) : each == name) parts.push_back(i);
  }
  if (!parts.empty()) return parts;
  if (const auto numbered = partNumbered(model, name)) parts.push_back(*numbered);
  return parts;
}

std::vector<std::string> namesOfParts(const scene::Model& model,
                                      std::span<const std::size_t> parts) {
  std::vector<std::string> names;
  std::set<std::string_view> told;
  for (const std::size_t part : parts) {
    const std::string& name = model.parts[part].name;
    const auto isNamesake = [&](std::size_t each) { return model.parts[each].name == name; };
    const auto namesakes = std::ranges::count(model.parts, name, &scene::ModelPart::name);
    if (std::ranges::count_if(parts, isNamesake) == namesakes) {
      if (told.insert(name).second) names.push_back(name);
      continue;
    }
    const auto before =
        std::ranges::count(std::span(model.parts).first(part), name, &scene::ModelPart::name);
    names.push_back(fmt::format("{}#{}", name, before + 1));
  }
  return names;
}

std::string unknownNodeText(const std::string& name, const scene::Model& model) {
  if (const auto numbered = numberedName(name)) {
    const auto count = std::ranges::count(model.parts, numbered->stem, &scene::ModelPart::name);
    if (count > 0) {
      return fmt::format("the model has no node {}: its nodes \"{}\" are {}, from #1 on",
                         config::quoted(name), numbered->stem, count);
    }
  }
  const std::vector<std::string> known = nodeNames(model);
  // CAD programs add numbers to names: the beginning of one may be meant.
  const auto beginsSo = [&](const std::string& each) { return each.starts_with(name); };
  const bool isBeginning = !name.empty() && std::ranges::any_of(known, beginsSo);
  const std::vector<std::string> meant = isBeginning           ? std::vector{name + "*"}
                                         : name.ends_with('*') ? patternsOf(known)
                                                               : known;
  return "the model has no node " + config::foundText(name, meant);
}

}  // namespace pleinair::procedure
