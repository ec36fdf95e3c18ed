#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "pipeline/scene/description/scene.h"

namespace pleinair::scene {

/// Reads a scene file (TOML). All that one may hold, with defaults where a key may be left out:
///
///     [camera]                    # without it, assumedCamera() has to do
///     calibration = "camera.toml" # beside the scene file; or a calibration's keys right here
///     [light]                     # left out, it is this one: the upper left behind a viewer
///     direction = [-0.4, 0.6, 0.8]  # towards the light
///     frame = "attached"          # as the models'; "camera": x right, y up, z to the viewer
///     [[tag]]
///     family = "tag36h11"
///     id = 0
///     edge_m = 0.12               # of the black square
///     position_m = [0, 0, 0]      # in the world; neither of these: the tag tells no world
///     rotation_deg = [0, 0, 0]
///     [[model]]
///     name = "gear"
///     source = "builtin:gear"     # or "builtin:box", which has size_m = [x, y, z],
///                                 # "builtin:gearbox" with length_m, speed_rpm, stage_1, stage_2
///                                 # and cover, or a glTF file beside the scene file
///     attach = "tag:0"            # or "world"
///     position_m = [0, 0, 0]
///     rotation_deg = [0, 0, 0]
///     scale = 1.0
///     colour = [0.8, 0.5, 0.2]    # sRGB; or "#cc8033"
///     focus = 0.0                 # 1: kept crisp by every style
///     stroke_direction = "curvature"  # or "tangents", "picture", or a direction [x, y, z]
///     teeth = 18                  # of a gear, as are module_m, thickness_m, pressure_angle_deg,
///                                 # bore_diameter_m, hub_diameter_m, holes
///
/// Frames are the attach frames (scene.h): on a tag, x goes to its right, y to its top, z out of
/// it. rotation_deg turns about the fixed axes x, then y, then z (Rz · Ry · Rx), as Blender's XYZ
/// angles and URDF's roll, pitch, yaw do; scale comes first, position last.
///
/// Throws config::ConfigError for whatever is wrong with it, or with a calibration that it names.
Scene loadScene(const std::filesystem::path& path);

/// The same as loadScene(), from text. Messages name the file `name`; its file names are relative
/// to `directory`.
Scene parseScene(std::string_view text, std::string name, const std::filesystem::path& directory);

}  // namespace pleinair::scene
