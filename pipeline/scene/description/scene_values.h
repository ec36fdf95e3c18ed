#pragma once

#include <filesystem>
#include <optional>
#include <string_view>

#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

#include "config/toml_reader.h"
#include "pipeline/scene/description/model_source.h"

namespace pleinair::scene {

/// Reads position_m and rotation_deg as a transform to the frame that they are given in; nothing if
/// the table has neither.
std::optional<glm::dmat4> readPose(const config::TomlTable& table);

/// Throws config::ConfigError where the table has a length in another unit than metres, or without
/// one: "edge_mm" or "edge" for "edge_m". Precondition: `key` ends in "_m".
void refuseOtherUnits(const config::TomlTable& table, std::string_view key);

/// A colour: three sRGB numbers or "#rrggbb"; sRGB-coded.
std::optional<glm::vec3> readColour(const config::TomlTable& table,
                                    std::string_view key = "colour");

/// Reads `source` and the keys that belong to it. File names are relative to `directory`.
ModelSource readSource(const config::TomlTable& table, const std::filesystem::path& directory);

/// Metres of a file's unit by the key `units` ("m", "mm", "cm", "in"), which STL and OBJ files
/// need; 1 for others without it.
double readFileUnits(const config::TomlTable& table, const FileSource& file);

/// The transform from a model file's own axes and lengths to the model's frame, which is in metres
/// with z up: of the keys `units` ("m", "mm", "cm", "in") and `up` ("y", "z"). STL and OBJ files,
/// which do not say their units, need `units`; without `up`, STL is z up and OBJ y up. glTF is in
/// metres and y up, unless the keys say otherwise.
glm::dmat4 readFileFrame(const config::TomlTable& table, const FileSource& file);

}  // namespace pleinair::scene
