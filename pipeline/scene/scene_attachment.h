#pragma once

#include <optional>

#include "config/toml_reader.h"
#include "pipeline/scene/scene.h"

namespace pleinair::scene {

/// attach: the id of one of the scene's tags, read before; nothing for the world. Throws
/// config::ConfigError.
std::optional<int> readAttachment(const config::TomlTable& table, const Scene& scene);

}  // namespace pleinair::scene
