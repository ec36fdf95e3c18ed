#include "pipeline/styles/style_registry.h"

#include <array>
#include <string>

#include <fmt/format.h>

#include "config/config_error.h"
#include "config/suggestion.h"
#include "config/toml_reader.h"
#include "hal/error.h"
#include "pipeline/styles/painterly/painterly.h"
#include "pipeline/styles/painterly/painterly_parameters.h"
#include "pipeline/styles/painterly/painterly_shaders.h"
#include "pipeline/styles/plain.h"
#include "pipeline/styles/substrate/substrate_shaders.h"
#include "pipeline/styles/watercolor/watercolor.h"
#include "pipeline/styles/watercolor/watercolor_parameters.h"
#include "pipeline/styles/watercolor/watercolor_shaders.h"

namespace pleinair::styles {
namespace {

struct Entry {
  StyleInfo info;
  std::unique_ptr<Style> (*make)(const gpu::ShaderLibrary& library) = nullptr;
};

const std::array<Entry, 3>& entries() {
  static const std::array<Entry, 3> kEntries{{
      {{.name = "watercolor",
        .help = "washes of pigment on paper (thesis chapter III, and on)",
        .views = watercolorViews(),
        .looks = watercolorLooks(),
        .defaults = watercolorParameters().defaults()},
       [](const gpu::ShaderLibrary& library) -> std::unique_ptr<Style> {
         return std::make_unique<Watercolor>(library);
       }},
      {{.name = "painterly",
        .help = "layers of brush strokes that live (thesis chapter IV, and on)",
        .views = painterlyViews(),
        .looks = painterlyLooks(),
        .defaults = painterlyParameters().defaults(),
        .check = checkPainterly},
       [](const gpu::ShaderLibrary& library) -> std::unique_ptr<Style> {
         return std::make_unique<Painterly>(library);
       }},
      {{.name = "none",
        .help = "the camera's picture with its virtual objects, unpainted",
        .views = {},
        .looks = {},
        .defaults = plainParameters()},
       [](const gpu::ShaderLibrary&) -> std::unique_ptr<Style> {
         return std::make_unique<Plain>();
       }},
  }};
  return kEntries;
}

const Entry& entryOf(std::string_view name) {
  std::vector<std::string> names;
  for (const Entry& entry : entries()) {
    if (entry.info.name == name) return entry;
    names.emplace_back(entry.info.name);
  }
  throw hal::Failure({.kind = hal::ErrorKind::kInvalidArgument,
                      .subject = fmt::format("style \"{}\"", name),
                      .problem = config::unknownText("style", name, names),
                      .remedy = "choose one of: " + config::listText(names)});
}

}  // namespace

config::ParameterValues StyleInfo::parametersOf(std::string_view look) const {
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

std::span<const StyleInfo> styleInfos() {
  static const std::array<StyleInfo, 3> kInfos{entries()[0].info, entries()[1].info,
                                               entries()[2].info};
  return kInfos;
}

const StyleInfo& styleInfo(std::string_view name) {
  return entryOf(name).info;
}

void addStyleShaders(gpu::ShaderLibrary& library) {
  library.add(gpu::substrateShaders());
  library.add(gpu::watercolorShaders());
  library.add(gpu::painterlyShaders());
}

std::unique_ptr<Style> makeStyle(std::string_view name, const gpu::ShaderLibrary& library) {
  return entryOf(name).make(library);
}

}  // namespace pleinair::styles
