#include "pipeline/styles/style.h"

#include <algorithm>
#include <cassert>
#include <cctype>
#include <string>

#include <fmt/format.h>

#include "config/config_error.h"
#include "config/suggestion.h"
#include "config/toml_reader.h"

namespace pleinair::styles {

std::size_t viewIndex(std::span<const DebugViewInfo> views, std::string_view view) {
  const auto found = std::ranges::find(views, view, &DebugViewInfo::name);
  assert(found != views.end());
  return static_cast<std::size_t>(found - views.begin());
}

gpu::ShaderDefines viewDefines(std::span<const DebugViewInfo> views) {
  gpu::ShaderDefines defines;
  for (const DebugViewInfo& view : views) {
    std::string name(view.name);
    std::ranges::transform(name, name.begin(), [](unsigned char c) { return std::toupper(c); });
    defines.push_back({"VIEW_" + name, std::to_string(defines.size())});
  }
  return defines;
}

config::ParameterValues StyleKind::parametersOf(std::string_view look) const {
  std::vector<std::string> names;
  for (const Look& each : looks) {
    if (each.name == look) {
      const auto table = config::TomlDocument::parseText(each.toml, fmt::format("look {}", look));
      return defaults.with(table.root());
    }
    names.emplace_back(each.name);
  }
  throw config::ConfigError({.file = fmt::format("style {}", name),
                             .key = "look",
                             .found = std::string(look),
                             .allowed = names.empty() ? "it has none" : config::listText(names)});
}

}  // namespace pleinair::styles
