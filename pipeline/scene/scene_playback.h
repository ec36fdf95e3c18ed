#pragma once

#include <optional>
#include <string>

#include "config/toml_reader.h"
#include "pipeline/scene/playback.h"
#include "pipeline/scene/rig.h"

namespace pleinair::scene {

/// clip, speed, loop and start of a [[model]] with this rig; where there is only one clip, clip
/// need not be given. Throws a ConfigError for a clip that is not there, and for keys that do
/// nothing.
Playback readPlayback(const config::TomlTable& table, const Rig& rig);

/// Where a model has clips of which none is played: says so, and what to do.
std::optional<std::string> standingStillNotice(const Rig& rig, const Playback& playback);

}  // namespace pleinair::scene
