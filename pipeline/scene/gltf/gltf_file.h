#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>

#include "hal/error.h"
#include "pipeline/scene/models/model.h"

namespace pleinair::scene {

/// Reads a glTF 2.0 model (.glb or .gltf, told apart by content): the default scene's triangles
/// with their base colours, base-colour textures and vertex colours. Each node that shows a mesh
/// becomes a part of the same name. Where anything moves, the model has a rig of its nodes, with
/// its skins, and its animations as clips. Meshes are in their own frame; those with a skin are as
/// they were bound. glTF's y (up) becomes z and its z (front) becomes −y, so the model stands on a
/// tag and faces its reader. Lengths are metres, unchanged.
///
/// Opens no file but this one and those in its folder (links are followed), and only the files
/// used. Features left out (points, blending …) are listed in Model::notices. Errors: kInvalidInput
/// (broken, hostile or beyond the limits), kUnsupported (a required extension, or more joints or
/// morph targets than are supported), and FileInput's; one line with the file, the position and the
/// value found.
hal::Result<Model> readGltf(const std::filesystem::path& path);

/// The same from memory; opens no file. Errors name the file `name`.
hal::Result<Model> parseGltf(std::span<const std::uint8_t> bytes, const std::string& name);

}  // namespace pleinair::scene
