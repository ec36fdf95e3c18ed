#pragma once

#include <glm/vec3.hpp>

#include "pipeline/scene/models/mesh.h"

namespace pleinair::scene {

/// Makes a box that stands on z = 0, centred over the origin: 12 triangles. `sizeMetres` along x, y
/// and z, each > 0.
Mesh boxMesh(const glm::dvec3& sizeMetres);

}  // namespace pleinair::scene
