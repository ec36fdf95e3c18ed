#pragma once

#include <filesystem>
#include <variant>

#include <glm/vec3.hpp>

#include "hal/error.h"
#include "pipeline/scene/builtin/builtin_gear.h"
#include "pipeline/scene/builtin/builtin_gearbox.h"
#include "pipeline/scene/models/model.h"

namespace pleinair::scene {

struct BoxSource {
  glm::dvec3 sizeMetres{0.05};
  friend bool operator==(const BoxSource&, const BoxSource&) = default;
};

using GearSource = GearParameters;

using GearboxSource = GearboxParameters;

/// A glTF file.
struct FileSource {
  std::filesystem::path path;
  friend bool operator==(const FileSource&, const FileSource&) = default;
};

/// Where a model comes from. Equal sources give equal models.
using ModelSource = std::variant<BoxSource, GearSource, GearboxSource, FileSource>;

/// Errors: readGltf()'s, for files only. Preconditions: for a gear, faultOf() is
/// nothing; a gearbox has teeth within its ranges.
hal::Result<Model> modelOf(const ModelSource& source);

/// Whether its materials are coloured; others are white, to be given a colour.
bool hasOwnColours(const ModelSource& source);

}  // namespace pleinair::scene
