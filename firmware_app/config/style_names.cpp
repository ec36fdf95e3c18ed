#include "firmware_app/config/style_names.h"

#include <algorithm>
#include <vector>

#include <fmt/format.h>

#include "config/config_error.h"
#include "config/suggestion.h"
#include "firmware_app/config/configuration_sections.h"
#include "pipeline/engine/painter.h"
#include "pipeline/styles/registry.h"

namespace pleinair::app {
namespace {

using Names = std::vector<std::string>;

bool isAmong(const Names& names, const std::string& name) {
  return std::ranges::find(names, name) != names.end();
}

Names looksOf(std::string_view style) {
  Names names;
  for (const styles::Look& look : styles::styleKind(style).looks) names.emplace_back(look.name);
  return names;
}

Names viewsOf(std::string_view style) {
  Names names;
  for (const DebugView& view : debugViewsOf(style)) names.push_back(view.name);
  return names;
}

/// The first style that has the name; empty: none.
std::string styleWith(const std::string& name, Names (*namesOf)(std::string_view)) {
  for (const std::string& style : styleNames()) {
    if (isAmong(namesOf(style), name)) return style;
  }
  return {};
}

/// `own`: the names of the style in force; `what`: "look".
std::string foundName(const std::string& name, const Names& own, const char* what,
                      Names (*namesOf)(std::string_view)) {
  std::string found = config::quoted(name);
  if (const std::string other = styleWith(name, namesOf); !other.empty()) {
    return fmt::format("{} (a {} of {}: --style {})", found, what, other, other);
  }
  if (isAmong(styleNames(), name)) return fmt::format("{0} (a style: --style {1})", found, name);
  if (config::nearest(name, own)) return config::foundText(name, own);
  Names all;
  for (const std::string& style : styleNames()) {
    const Names names = namesOf(style);
    all.insert(all.end(), names.begin(), names.end());
  }
  const auto near = config::nearest(name, all);
  if (!near) return found;
  return fmt::format("{} (did you mean \"{}\", a {} of {}?)", found, *near, what,
                     styleWith(*near, namesOf));
}

}  // namespace

Names styleNames() {
  Names names;
  for (const styles::StyleKind* kind : styles::styleKinds()) names.emplace_back(kind->name);
  return names;
}

std::string foundStyle(const std::string& name, std::string_view look) {
  if (const std::string style = styleWith(name, looksOf); !style.empty()) {
    return fmt::format("{} (a look of {}: {})", config::quoted(name), style,
                       fmt::format(fmt::runtime(look), name));
  }
  return config::foundText(name, styleNames());
}

std::string foundLook(const std::string& name, std::string_view style) {
  Names own = looksOf(style);
  own.emplace_back(kDefaultLook);
  return foundName(name, own, "look", looksOf);
}

std::string foundView(const std::string& name, std::string_view style) {
  Names own = viewsOf(style);
  own.emplace_back(kFinishedView);
  return foundName(name, own, "view", viewsOf);
}

}  // namespace pleinair::app
