#pragma once

#include <array>
#include <map>
#include <set>
#include <tuple>

#include <glm/geometric.hpp>

#include "pipeline/scene/models/mesh.h"

namespace pleinair::scene {

/// A triangle's corners as double vectors.
inline std::array<glm::dvec3, 3> cornersOf(const Mesh& mesh, std::size_t triangle) {
  std::array<glm::dvec3, 3> corners;
  for (std::size_t i = 0; i < 3; ++i) {
    corners[i] = glm::dvec3(mesh.vertices[mesh.triangles[triangle][i]].position);
  }
  return corners;
}

inline glm::dvec3 areaVector(const std::array<glm::dvec3, 3>& corners) {
  return 0.5 * glm::cross(corners[1] - corners[0], corners[2] - corners[0]);
}

/// Volume by the divergence theorem; positive where triangles face outward.
inline double volumeOf(const Mesh& mesh) {
  double six = 0.0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto c = cornersOf(mesh, t);
    six += glm::dot(c[0], glm::cross(c[1], c[2]));
  }
  return six / 6.0;
}

/// Number of directed edges, by the positions of their ends, without exactly one opposite edge. 0
/// for a closed, consistently oriented 2-manifold.
inline int unmatchedEdges(const Mesh& mesh) {
  using Point = std::tuple<float, float, float>;
  const auto key = [&](std::uint32_t i) {
    const glm::vec3& p = mesh.vertices[i].position;
    return Point(p.x, p.y, p.z);
  };
  std::map<std::pair<Point, Point>, int> edges;
  for (const auto& t : mesh.triangles) {
    for (std::size_t i = 0; i < 3; ++i) ++edges[{key(t[i]), key(t[(i + 1) % 3])}];
  }
  int unmatched = 0;
  for (const auto& [edge, count] : edges) {
    const auto back = edges.find({edge.second, edge.first});
    if (count != 1 || back == edges.end() || back->second != 1) ++unmatched;
  }
  return unmatched;
}

/// V − E + F of the welded mesh: 2 − 2 · handles for one closed surface.
inline long eulerCharacteristic(const Mesh& mesh) {
  std::set<std::tuple<float, float, float>> points;
  for (const auto& t : mesh.triangles) {
    for (const std::uint32_t i : t) {
      const glm::vec3& p = mesh.vertices[i].position;
      points.emplace(p.x, p.y, p.z);
    }
  }
  const auto faces = static_cast<long>(mesh.triangles.size());
  return static_cast<long>(points.size()) - 3 * faces / 2 + faces;
}

/// Number of triangles without area, or with a vertex normal that is not a unit vector or deviates
/// by more than acos(`leastCosine`) from the triangle's own.
inline int wrongNormals(const Mesh& mesh, double leastCosine) {
  int wrong = 0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const glm::dvec3 area = areaVector(cornersOf(mesh, t));
    if (!(glm::length(area) > 0.0)) {
      ++wrong;
      continue;
    }
    for (const std::uint32_t i : mesh.triangles[t]) {
      const glm::dvec3 normal(mesh.vertices[i].normal);
      const bool isUnit = std::abs(glm::length(normal) - 1.0) < 1e-5;
      if (!isUnit || glm::dot(normal, glm::normalize(area)) < leastCosine) {
        ++wrong;
        break;
      }
    }
  }
  return wrong;
}

}  // namespace pleinair::scene
