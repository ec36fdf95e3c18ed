#pragma once

#include <filesystem>

#include "hal/error.h"
#include "pipeline/scene/models/model.h"

namespace pleinair::scene {

/// Whether a name has a mesh file's ending, in either case: .stl, .obj.
bool isMeshFile(const std::filesystem::path& path);
/// Whether the file's kind has colours of its own: .obj, by the .mtl beside it.
bool hasMaterials(const std::filesystem::path& path);

/// Reads an STL (binary or text) or OBJ model by assimp: lengths and axes as they are in the file.
/// Each object or group that has triangles is a part of its name. Normals that the file has are
/// kept, but STL's, which are those of facets; others are smoothed up to creases of 35°. Colours
/// are those of OBJ's materials; textures are not read, of which a notice tells.
///
/// Opens no file but this one and those in its folder. Errors: kInvalidInput (broken, without a
/// triangle, or beyond the limits of gltf_limits.h), and FileInput's. Any thread.
hal::Result<Model> readMeshFile(const std::filesystem::path& path);

}  // namespace pleinair::scene
