#pragma once

#include <variant>

#include <glm/vec3.hpp>

#include "pipeline/scene/builtin_gear.h"
#include "pipeline/scene/mesh.h"

namespace pleinair::scene {

struct BoxSource {
  glm::dvec3 sizeMetres{0.05};
  friend bool operator==(const BoxSource&, const BoxSource&) = default;
};

using GearSource = GearParameters;

/// Where a model's surface comes from. Equal sources give equal meshes.
using ModelSource = std::variant<BoxSource, GearSource>;

/// Precondition: for a gear, faultOf() is nothing.
Mesh meshOf(const ModelSource& source);

}  // namespace pleinair::scene
