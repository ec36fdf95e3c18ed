#pragma once

#include <algorithm>
#include <span>
#include <string>
#include <vector>

#include "config/suggestion.h"
#include "config/toml_reader.h"

namespace pleinair::procedure {

/// An error for each key of the table that is none of `known`. For readers that go on after a
/// mistake, and then ask for less than there may be: TomlTable::finish() would blame what they left
/// out.
inline std::vector<config::ConfigError> unknownKeys(const config::TomlTable& table,
                                                    std::span<const std::string> known) {
  std::vector<config::ConfigError> errors;
  for (const std::string& key : table.keys()) {
    if (std::ranges::find(known, key) != known.end()) continue;
    errors.push_back(
        table.error(key, config::unknownText("key", key, known), config::listText(known)));
  }
  return errors;
}

}  // namespace pleinair::procedure
