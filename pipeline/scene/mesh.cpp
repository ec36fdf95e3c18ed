#include "pipeline/scene/mesh.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <utility>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace pleinair::scene {
namespace {

using Corners = std::array<MeshVertex, 3>;

float squaredLength(const MeshVertex& a, const MeshVertex& b) {
  const glm::vec3 edge = a.position - b.position;
  return glm::dot(edge, edge);
}

MeshVertex midpoint(const MeshVertex& a, const MeshVertex& b) {
  const glm::vec3 sum = a.normal + b.normal;
  const float length = glm::length(sum);
  return {.position = 0.5F * (a.position + b.position),
          .normal = length > 1e-6F ? sum / length : a.normal,
          .texture = 0.5F * (a.texture + b.texture),
          .colour = 0.5F * (a.colour + b.colour)};
}

void append(Mesh& mesh, const Corners& corners) {
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  mesh.vertices.insert(mesh.vertices.end(), corners.begin(), corners.end());
  mesh.triangles.push_back({first, first + 1, first + 2});
}

}  // namespace

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

Mesh withShortEdges(const Mesh& mesh, float maxEdgeMetres, std::size_t mostTriangles) {
  assert(maxEdgeMetres > 0.0F);
  Mesh result;
  std::vector<Corners> pending;
  for (const auto& triangle : mesh.triangles) {
    pending.push_back(
        {mesh.vertices[triangle[0]], mesh.vertices[triangle[1]], mesh.vertices[triangle[2]]});
    while (!pending.empty()) {
      const Corners corners = pending.back();
      pending.pop_back();
      std::size_t longest = 0;  // the edge from this corner to the next
      float longestSquared = 0.0F;
      for (std::size_t i = 0; i < 3; ++i) {
        const float squared = squaredLength(corners[i], corners[(i + 1) % 3]);
        if (squared > longestSquared) {
          longest = i;
          longestSquared = squared;
        }
      }
      if (longestSquared <= maxEdgeMetres * maxEdgeMetres ||
          result.triangles.size() + pending.size() >= mostTriangles) {
        append(result, corners);
        continue;
      }
      const MeshVertex& a = corners[longest];
      const MeshVertex& b = corners[(longest + 1) % 3];
      const MeshVertex& c = corners[(longest + 2) % 3];
      const MeshVertex middle = midpoint(a, b);
      pending.push_back({middle, b, c});
      pending.push_back({a, middle, c});
    }
  }
  return result;
}

}  // namespace pleinair::scene
