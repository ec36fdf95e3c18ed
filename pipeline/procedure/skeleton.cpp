#include "pipeline/procedure/skeleton.h"

#include <algorithm>
#include <cassert>
#include <set>
#include <string_view>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "config/toml_text.h"
#include "pipeline/procedure/procedure_file.h"

namespace pleinair::procedure {
namespace {

/// Nodes that one step is about.
struct NodeGroup {
  std::string stem;  ///< "bolt" of bolt_1 and bolt_2
  std::size_t triangles = 0;
  std::vector<std::string> names;
  bool isFirst = true;  ///< of its stem
  /// Stands for it: nodes of other shapes may have the stem, too.
  const std::string& title() const { return isFirst && names.size() > 1 ? stem : names.front(); }
};

/// "bolt_12" and "bolt.012" without the number.
std::string stemOf(std::string_view name) {
  std::string_view stem = name;
  while (!stem.empty() && stem.back() >= '0' && stem.back() <= '9') stem.remove_suffix(1);
  const bool isNumbered = stem.size() < name.size();
  while (isNumbered && !stem.empty() &&
         (stem.back() == '_' || stem.back() == '.' || stem.back() == ' ')) {
    stem.remove_suffix(1);
  }
  return std::string(isNumbered && !stem.empty() ? stem : name);
}

/// A series is of one shape: CAD programs number different bodies as well ("body_1", "body_2").
std::vector<NodeGroup> groupsOf(const scene::Model& model) {
  std::vector<NodeGroup> groups;
  std::set<std::string_view> known;
  for (const scene::ModelPart& part : model.parts) {
    if (!known.insert(part.name).second) continue;
    const std::string stem = stemOf(part.name);
    const auto triangles = static_cast<std::size_t>(part.triangleCount);
    auto group = std::ranges::find_if(groups, [&](const NodeGroup& each) {
      return each.stem == stem && each.triangles == triangles;
    });
    if (group == groups.end()) {
      const bool isFirst = std::ranges::find(groups, stem, &NodeGroup::stem) == groups.end();
      group = groups.insert(
          groups.end(), {.stem = stem, .triangles = triangles, .names = {}, .isFirst = isFirst});
    }
    group->names.push_back(part.name);
  }
  return groups;
}

/// "bolt_*" where that is just these nodes, or their names.
std::vector<std::string> patternOf(const NodeGroup& group, const scene::Model& model) {
  if (group.names.size() < 3) return group.names;
  const std::string& first = group.names.front();
  const std::string prefix = first.substr(0, first.find_last_not_of("0123456789") + 1);
  std::set<std::string> matched;
  for (const scene::ModelPart& part : model.parts) {
    if (part.name.starts_with(prefix)) matched.insert(part.name);
  }
  const std::set<std::string> wanted(group.names.begin(), group.names.end());
  return matched == wanted ? std::vector{prefix + "*"} : group.names;
}

/// A step's id: lower-case letters, digits and _.
std::string idOf(std::string_view text, std::set<std::string>& used) {
  constexpr std::size_t kLongest = 56;  // leaves room for a number
  std::string id;
  for (const char c : text.substr(0, kLongest)) {
    const bool isUpper = c >= 'A' && c <= 'Z';
    const bool isKept = (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9');
    if (isUpper) {
      id += static_cast<char>(c - 'A' + 'a');
    } else if (isKept) {
      id += c;
    } else if (!id.empty() && id.back() != '_') {
      id += '_';
    }
  }
  while (id.ends_with('_')) id.pop_back();
  if (id.empty() || id == "end") id = "part";
  std::string unique = id;
  for (int number = 2; !used.insert(unique).second; ++number) {
    unique = fmt::format("{}_{}", id, number);
  }
  return unique;
}

std::string titleOf(const NodeGroup& group) {
  std::string title = group.title();
  std::ranges::replace(title, '_', ' ');
  std::ranges::replace(title, '\n', ' ');
  return title.find_first_not_of(' ') == std::string::npos ? "part" : title;
}

}  // namespace

Skeleton skeletonOf(const scene::Model& model, const std::string& name, const std::string& source,
                    const std::string& units, std::span<const std::string> languages) {
  assert(!languages.empty());
  const auto inQuotes = [](const std::string& text) {
    return config::tomlString(text).value_or("\"\"");
  };
  Skeleton skeleton;
  std::vector<std::string> tags;
  for (const std::string& each : languages) tags.push_back(inQuotes(each));
  skeleton.toml = fmt::format(
      "# docs/repair-station.md describes the format. Bring the steps into their order, say what\n"
      "# each removes or fits, and delete those that nobody needs.\n"
      "name = {}\nversion = \"0.1\"\nlanguages = [{}]\n\n[model]\nsource = {}\n",
      inQuotes(name), fmt::join(tags, ", "), inQuotes(source));
  if (!units.empty()) skeleton.toml += fmt::format("units = {}\n", inQuotes(units));
  for (const std::string& each : languages) skeleton.texts[each] = "# " + name + "\n";
  std::set<std::string> used;
  for (const NodeGroup& group : groupsOf(model)) {
    if (skeleton.steps == kMaxSteps) {
      skeleton.leftOut.insert(skeleton.leftOut.end(), group.names.begin(), group.names.end());
      continue;
    }
    ++skeleton.steps;
    const std::string id = idOf(group.title(), used);
    std::vector<std::string> parts;
    for (const std::string& each : patternOf(group, model)) parts.push_back(inQuotes(each));
    skeleton.toml +=
        fmt::format("\n[[step]]\nid = \"{}\"\nparts = [{}]\n", id, fmt::join(parts, ", "));
    for (const std::string& each : languages) {
      skeleton.texts[each] += fmt::format("\n## {}: {}\n", id, titleOf(group));
    }
  }
  return skeleton;
}

}  // namespace pleinair::procedure
