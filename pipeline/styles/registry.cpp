#include "pipeline/styles/registry.h"

#include <array>
#include <set>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "config/suggestion.h"
#include "hal/error.h"

namespace pleinair::styles {

// One line a style: the descriptor that its folder exports, in the order of lists.
#define PLEINAIR_STYLES(STYLE) \
  STYLE(watercolorKind)        \
  STYLE(painterlyKind)         \
  STYLE(hatchingKind)          \
  STYLE(plainKind)

#define PLEINAIR_DECLARE(kind) const StyleKind& kind();
PLEINAIR_STYLES(PLEINAIR_DECLARE)
#undef PLEINAIR_DECLARE

std::span<const StyleKind* const> styleKinds() {
#define PLEINAIR_ADDRESS(kind) &kind(),
  static const std::array kKinds{PLEINAIR_STYLES(PLEINAIR_ADDRESS)};
#undef PLEINAIR_ADDRESS
  return kKinds;
}

const StyleKind& styleKind(std::string_view name) {
  std::vector<std::string> names;
  for (const StyleKind* kind : styleKinds()) {
    if (kind->name == name) return *kind;
    names.emplace_back(kind->name);
  }
  throw hal::Failure({.kind = hal::ErrorKind::kInvalidArgument,
                      .subject = fmt::format("style \"{}\"", name),
                      .problem = config::unknownText("style", name, names),
                      .remedy = "choose one of: " + config::listText(names)});
}

void addStyleShaders(gpu::ShaderLibrary& library) {
  std::set<const gpu::EmbeddedShader*> added;
  for (const StyleKind* kind : styleKinds()) {
    for (const std::span<const gpu::EmbeddedShader> shaders : kind->shaders) {
      if (added.insert(shaders.data()).second) library.add(shaders);
    }
  }
}

std::unique_ptr<Style> makeStyle(std::string_view name, const gpu::ShaderLibrary& library,
                                 SceneContents contents) {
  return styleKind(name).make(library, contents);
}

}  // namespace pleinair::styles
