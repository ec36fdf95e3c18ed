#include "pipeline/scene/models/mesh.h"

#include <algorithm>
#include <cmath>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>

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

double largestScale(const glm::dmat4& transform) {
  // The largest eigenvalue of MᵀM is at most its largest row sum of magnitudes, and at most its
  // trace.
  const glm::dmat3 linear(transform);
  const glm::dmat3 squares = glm::transpose(linear) * linear;
  double largest = 0.0;
  for (int i = 0; i < 3; ++i) {
    largest = std::max(largest,
                       std::abs(squares[i][0]) + std::abs(squares[i][1]) + std::abs(squares[i][2]));
  }
  return std::sqrt(std::min(largest, squares[0][0] + squares[1][1] + squares[2][2]));
}

BoundingSphere transformed(const BoundingSphere& sphere, const glm::dmat4& transform) {
  return {.centre = glm::dvec3(transform * glm::dvec4(sphere.centre, 1.0)),
          .radiusMetres = largestScale(transform) * sphere.radiusMetres};
}

glm::dmat3 normalsAlong(const glm::dmat3& linear) {
  const glm::dmat3 cofactors(glm::cross(linear[1], linear[2]), glm::cross(linear[2], linear[0]),
                             glm::cross(linear[0], linear[1]));
  return glm::determinant(linear) < 0.0 ? -cofactors : cofactors;
}

}  // namespace pleinair::scene
