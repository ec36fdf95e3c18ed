#pragma once

#include "config/toml_reader.h"
#include "pipeline/scene/scene.h"

namespace pleinair::scene {

/// A scene file's [light]:
///
///     mode = "estimated"          # from the camera's pictures; or "fixed"
///     direction = [-0.4, 0.6, 0.8]  # towards the key light; left out, it is estimated too
///     frame = "attached"          # as the models'; "camera": x right, y up, z to the viewer
///     key = "#fff1dd"             # fixed: white paper that faces the key light and sees no other
///     ambient = [0.6, 0.65, 0.7]  # fixed: white paper that the key light does not reach
///     shadow = 0.9                # of models on what they stand on; 0: none
///
/// Throws config::ConfigError.
Light readLight(const config::TomlTable& table);

}  // namespace pleinair::scene
