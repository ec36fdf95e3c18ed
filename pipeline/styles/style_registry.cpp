#include "pipeline/styles/style_registry.h"

#include <algorithm>
#include <array>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "config/suggestion.h"
#include "hal/error.h"
#include "pipeline/styles/plain.h"
#include "pipeline/styles/watercolor/watercolor.h"
#include "pipeline/styles/watercolor/watercolor_shaders.h"

namespace pleinair::styles {
namespace {

struct Entry {
  StyleInfo info;
  std::unique_ptr<Style> (*make)(const gpu::ShaderLibrary& library) = nullptr;
};

constexpr std::array<Entry, 2> kEntries{{
    {{"watercolor", "washes on paper under dark edges (thesis chapter III)"},
     [](const gpu::ShaderLibrary& library) -> std::unique_ptr<Style> {
       return std::make_unique<Watercolor>(library);
     }},
    {{"none", "the camera's picture with its virtual objects, unpainted"},
     [](const gpu::ShaderLibrary&) -> std::unique_ptr<Style> { return std::make_unique<Plain>(); }},
}};

constexpr auto kInfos = [] {
  std::array<StyleInfo, kEntries.size()> infos{};
  for (std::size_t i = 0; i < infos.size(); ++i) infos[i] = kEntries[i].info;
  return infos;
}();

}  // namespace

std::span<const StyleInfo> styleInfos() {
  return kInfos;
}

void addStyleShaders(gpu::ShaderLibrary& library) {
  library.add(gpu::watercolorShaders());
}

std::unique_ptr<Style> makeStyle(std::string_view name, const gpu::ShaderLibrary& library) {
  for (const Entry& entry : kEntries) {
    if (entry.info.name == name) return entry.make(library);
  }
  std::vector<std::string> names;
  for (const StyleInfo& info : kInfos) names.emplace_back(info.name);
  throw hal::StartupError({.kind = hal::ErrorKind::kInvalidArgument,
                           .subject = fmt::format("style \"{}\"", name),
                           .problem = config::unknownText("style", name, names),
                           .remedy = "choose one of: " + config::listText(names)});
}

}  // namespace pleinair::styles
