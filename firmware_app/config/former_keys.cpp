#include "firmware_app/config/former_keys.h"

#include <algorithm>
#include <array>
#include <cctype>

#include <fmt/format.h>

#include "config/config_error.h"
#include "firmware_app/config/configuration_sections.h"

namespace pleinair::app {
namespace {

struct FormerKey {
  std::string_view section;
  std::string_view name;
  std::string_view now;  ///< how the same is written today
};

constexpr std::array kFormerKeys{
    FormerKey{"output", "target", "output.targets, a list: targets = [\"window\"]"},
    FormerKey{"output", "second_target",
              "output.targets, a list: targets = [\"window\", \"a.mp4\"]"},
    FormerKey{"output", "third_target",
              "output.targets, a list: targets = [\"window\", \"a.mp4\"]"},
    FormerKey{"output", "loopback_format", "format of [output.loopback]"},
};

std::string variableOf(const FormerKey& key) {
  std::string name = fmt::format("{}{}_{}", kVariablePrefix, key.section, key.name);
  std::ranges::transform(name, name.begin(), [](unsigned char c) { return std::toupper(c); });
  return name;
}

std::string problemOf(const FormerKey& key) {
  return fmt::format("is now {}", key.now);
}

}  // namespace

void refuseFormerKeys(const config::TomlTable& root) {
  for (const FormerKey& key : kFormerKeys) {
    // Whether it is a table at all is judged with the other keys.
    if (!root.has(key.section) || !root.isTable(key.section)) continue;
    const config::TomlTable table = root.table(key.section);
    if (table.has(key.name)) throw table.error(key.name, problemOf(key));
  }
}

void refuseFormerKey(const config::EnvironmentVariable& variable) {
  for (const FormerKey& key : kFormerKeys) {
    if (variable.name != variableOf(key)) continue;
    throw config::ConfigError({.file = variable.name, .problem = problemOf(key)});
  }
}

void refuseFormerKey(std::string_view key, const std::string& origin) {
  for (const FormerKey& each : kFormerKeys) {
    if (key != fmt::format("{}.{}", each.section, each.name)) continue;
    throw config::ConfigError({.file = origin, .problem = problemOf(each)});
  }
}

}  // namespace pleinair::app
