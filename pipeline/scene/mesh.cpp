#include "pipeline/scene/mesh.h"

#include <algorithm>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace pleinair::scene {

BoundingSphere boundingSphere(const Mesh& mesh) {
  if (mesh.vertices.empty()) return {};
  glm::dvec3 low(mesh.vertices.front().position);
  glm::dvec3 high = low;
  for (const MeshVertex& vertex : mesh.vertices) {
    low = glm::min(low, glm::dvec3(vertex.position));
    high = glm::max(high, glm::dvec3(vertex.position));
  }
  BoundingSphere sphere{.centre = 0.5 * (low + high)};
  for (const MeshVertex& vertex : mesh.vertices) {
    sphere.radiusMetres =
        std::max(sphere.radiusMetres, glm::distance(sphere.centre, glm::dvec3(vertex.position)));
  }
  return sphere;
}

}  // namespace pleinair::scene
