#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>

#include "hal/error.h"
#include "pipeline/scene/models/model.h"

namespace pleinair::scene {

/// A glTF 2.0 model (.glb or .gltf, told apart by content): the default scene's triangles with
/// their base colours, base-colour textures and vertex colours; a part for each node that shows a
/// mesh, under its name; and, where anything of it moves, a rig of its nodes, with its skins and
/// animations as clips. Meshes are in their own frame, those with a skin as they were bound to it.
/// glTF's y (up) becomes z, its z (front) −y: it stands on a tag and looks to whoever reads the
/// tag. Metres as they are.
///
/// Nothing is opened but the file and what lies in its folder (links followed), and only what is
/// used. What is left out (points, blending …) is in Model::notices. Errors: kInvalidInput (broken,
/// hostile or beyond the limits), kUnsupported (a required extension, or more joints or morph
/// targets than are posed), and FileInput's; one line with file, place and what was found.
hal::Result<Model> readGltf(const std::filesystem::path& path);

/// The same from memory; opens no file. `name` stands for the file in errors.
hal::Result<Model> parseGltf(std::span<const std::uint8_t> bytes, const std::string& name);

}  // namespace pleinair::scene
