#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <glm/vec3.hpp>

#include "pipeline/scene/models/mesh.h"

namespace pleinair::scene {

/// Range of a morph target's vertex offsets at weight 1, along each axis.
struct MorphBounds {
  glm::vec3 min{0.0F};
  glm::vec3 max{0.0F};
};

/// A sphere around the vertices that a joint holds.
struct JointBounds {
  std::uint16_t joint = 0;
  float radiusMetres = 0.0F;
  glm::vec3 centre{0.0F};
};

/// Bounds of a surface's vertices and of their possible positions, so that bounding a pose need not
/// visit each vertex.
struct SurfaceBounds {
  BoundingSphere sphere;            ///< of the mesh at rest
  std::vector<MorphBounds> morphs;  ///< per morph target
  std::vector<JointBounds> joints;  ///< per joint that holds any vertex; none without a skin
};

SurfaceBounds boundsOf(const Mesh& mesh);

}  // namespace pleinair::scene
