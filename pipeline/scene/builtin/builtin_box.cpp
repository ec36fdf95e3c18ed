#include "pipeline/scene/builtin/builtin_box.h"

#include <cassert>

namespace pleinair::scene {

Mesh boxMesh(const glm::dvec3& sizeMetres) {
  assert(sizeMetres.x > 0.0 && sizeMetres.y > 0.0 && sizeMetres.z > 0.0);
  const glm::vec3 half(0.5 * sizeMetres);
  const glm::vec3 centre(0.0F, 0.0F, half.z);
  Mesh mesh;
  for (int axis = 0; axis < 3; ++axis) {
    for (const float side : {-1.0F, 1.0F}) {
      glm::vec3 normal(0.0F);
      normal[axis] = side;
      // u × v = normal
      glm::vec3 u(0.0F);
      glm::vec3 v(0.0F);
      u[(axis + 1) % 3] = side;
      v[(axis + 2) % 3] = 1.0F;
      const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
      for (const glm::vec3& corner : {-u - v, u - v, u + v, -u + v}) {
        mesh.vertices.push_back({.position = centre + half * (normal + corner), .normal = normal});
      }
      mesh.triangles.push_back({first, first + 1, first + 2});
      mesh.triangles.push_back({first, first + 2, first + 3});
    }
  }
  return mesh;
}

}  // namespace pleinair::scene
