#pragma once

#include <filesystem>
#include <variant>

#include <glm/vec3.hpp>

#include "hal/error.h"
#include "pipeline/scene/builtin/builtin_gear.h"
#include "pipeline/scene/builtin/builtin_gearbox.h"
#include "pipeline/scene/builtin/builtin_moving.h"
#include "pipeline/scene/models/model.h"

namespace pleinair::scene {

struct BoxSource {
  glm::dvec3 sizeMetres{0.05};
  friend bool operator==(const BoxSource&, const BoxSource&) = default;
};

using GearSource = GearParameters;

using GearboxSource = GearboxParameters;

using TubeSource = TubeParameters;

using BallSource = BallParameters;

/// A glTF, STL or OBJ file.
struct FileSource {
  std::filesystem::path path;
  friend bool operator==(const FileSource&, const FileSource&) = default;
};

/// Source of a model. Equal sources give equal models.
using ModelSource =
    std::variant<BoxSource, GearSource, GearboxSource, TubeSource, BallSource, FileSource>;

/// Loads or makes the model, simplified (simplified_model.h). Errors: those of readGltf() and
/// readMeshFile(), for files only. Preconditions: faultOf() a gear is nothing; a gearbox has
/// numbers of teeth in range.
hal::Result<Model> modelOf(const ModelSource& source);

/// Whether the source's materials have colours. Other models are white and take the scene's colour.
bool hasOwnColours(const ModelSource& source);

}  // namespace pleinair::scene
