#pragma once

#include <string>
#include <string_view>

#include "config/sections.h"
#include "config/toml_reader.h"

namespace pleinair::app {

// Keys that have other names now. Each of these throws a config::ConfigError that names the place
// and the new key where a layer gives a former one.

void refuseFormerKeys(const config::TomlTable& root);
void refuseFormerKey(const config::EnvironmentVariable& variable);
/// `key` with its section; `origin` as of Sections::apply().
void refuseFormerKey(std::string_view key, const std::string& origin);

}  // namespace pleinair::app
