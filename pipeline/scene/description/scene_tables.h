#pragma once

#include <optional>
#include <string>

#include "config/toml_reader.h"
#include "pipeline/scene/description/scene.h"
#include "pipeline/scene/models/model.h"
#include "pipeline/scene/models/rig.h"

namespace pleinair::scene {

/// Reads `attach`: the id of one of the scene's tags, which must be read already; nothing for the
/// world. Throws config::ConfigError.
std::optional<int> readAttachment(const config::TomlTable& table, const Scene& scene);

/// Reads the [[plane]] tables into `scene`, whose tags must be read already. Throws
/// config::ConfigError.
void readPlanes(const config::TomlTable& root, Scene& scene);

/// Reads the [[focus]] tables into `scene`, whose tags must be read already:
///
///     attach = "tag:0"
///     position_m = [0, 0.1, 0.05]  # its centre, in the frame of what it is attached to
///     radius_m = 0.2
///     falloff_m = 0.2              # beyond the radius; left out, as much as the radius
///     strength = 1                 # 0: no effect
///
/// Throws config::ConfigError.
void readFoci(const config::TomlTable& root, Scene& scene);

/// Reads clip, speed, loop and start of a [[model]] with this rig. The clip may be left out if
/// there is only one. Throws config::ConfigError for an unknown clip, and for keys without effect.
Playback readPlayback(const config::TomlTable& table, const Rig& rig);

/// Reads stroke_direction of a [[model]]: `"curvature"`, `"tangents"`, `"picture"` or `[x, y, z]`.
/// Throws config::ConfigError, also where `model` has no tangents or `isOccluder`.
StrokeDirection readStrokeDirection(const config::TomlTable& table, const Model& model,
                                    bool isOccluder);

/// A notice for a model that has clips, none of which is played; it names the key to set.
std::optional<std::string> unplayedClipsNotice(const Rig& rig, const Playback& playback);

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
