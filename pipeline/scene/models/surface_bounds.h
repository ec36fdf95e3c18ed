#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <glm/vec3.hpp>

#include "pipeline/scene/models/mesh.h"

namespace pleinair::scene {

/// How far a morph target moves vertices at weight 1, along each axis.
struct MorphBounds {
  glm::vec3 least{0.0F};
  glm::vec3 most{0.0F};
};

/// Around the vertices that a joint holds.
struct JointBounds {
  std::uint16_t joint = 0;
  float radiusMetres = 0.0F;
  glm::vec3 centre{0.0F};
};

/// Where a surface's vertices are and may go to, so that a pose's bounds need not look at each.
struct SurfaceBounds {
  BoundingSphere sphere;            ///< as the mesh is
  std::vector<MorphBounds> morphs;  ///< of each of its targets
  std::vector<JointBounds> joints;  ///< of each that holds any vertex; none without a skin
};

SurfaceBounds boundsOf(const Mesh& mesh);

}  // namespace pleinair::scene
