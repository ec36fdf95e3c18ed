#include "firmware_app/config/look_file.h"

#include <algorithm>
#include <cctype>
#include <optional>
#include <vector>

#include <fmt/format.h>

#include "config/toml_reader.h"
#include "firmware_app/config/style_names.h"
#include "pipeline/styles/registry.h"

namespace pleinair::app {
namespace {

using config::TomlTable;

config::ParameterValues baseOf(const styles::StyleKind& kind, const TomlTable& painting) {
  if (!painting.has("look")) return kind.defaults;
  std::vector<std::string> names;
  for (const styles::Look& look : kind.looks) names.emplace_back(look.name);
  return kind.parametersOf(names[painting.choice("look", names)]);
}

}  // namespace

bool isLookFile(const std::filesystem::path& look) {
  std::string ending = look.extension().string();
  std::ranges::transform(ending, ending.begin(),
                         [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return ending == ".toml";
}

LookFile readLookFile(const std::filesystem::path& file) {
  const config::TomlDocument document = config::TomlDocument::parseFile(file);
  const TomlTable& root = document.root();
  const TomlTable painting = root.table("painting");
  const std::vector<std::string> names = styleNames();
  std::string style = names[painting.choice("style", names)];
  const styles::StyleKind& kind = styles::styleKind(style);
  config::ParameterValues values = baseOf(kind, painting);
  if (const std::optional<TomlTable> tables = root.optionalTable("style")) {
    if (const auto own = tables->optionalTable(style)) values = values.with(*own);
    tables->finish();
  }
  painting.finish();
  root.finish();
  return {.style = std::move(style), .values = std::move(values)};
}

std::string lookFileText(std::string_view style, const config::ParameterValues& values) {
  std::string text = fmt::format(
      "# A look of pleinair: `--look FILE` paints with it; it may be used as a site file, too.\n\n"
      "[painting]\nstyle = \"{}\"\n",
      style);
  const std::string given = values.toToml(config::Printed::kGiven);
  if (!given.empty()) text += fmt::format("\n[style.{}]\n{}", style, given);
  return text;
}

}  // namespace pleinair::app
