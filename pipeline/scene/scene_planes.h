#pragma once

#include "config/toml_reader.h"
#include "pipeline/scene/scene.h"

namespace pleinair::scene {

/// Reads the [[plane]] tables into `scene`, whose tags are read. Throws config::ConfigError.
void readPlanes(const config::TomlTable& root, Scene& scene);

}  // namespace pleinair::scene
