#include "pipeline/scene/models/simplified_model.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <meshoptimizer.h>

#include "pipeline/scene/models/mesh.h"

namespace pleinair::scene {
namespace {

constexpr double kErrorOfModel = 1.0 / 1000.0;
constexpr double kErrorOfSurface = 1.0 / 250.0;
/// meshoptimizer limits the root of a mean square; the largest distance is up to three times that.
constexpr double kMeanOfLargest = 0.3;

using Triangle = std::array<std::uint32_t, 3>;

/// The normal's length is twice the area.
glm::vec3 acrossOf(const Mesh& mesh, const Triangle& corners) {
  const glm::vec3 a = mesh.vertices[corners[0]].position;
  return glm::cross(mesh.vertices[corners[1]].position - a, mesh.vertices[corners[2]].position - a);
}

/// Whether the normals are those of the triangles, up to the rounding of edges between them. Some
/// slivers, whose form says nothing, may differ.
bool hasNormalsOfItsForm(const Mesh& mesh) {
  const float kMinCosine = std::cos(glm::radians(40.0F));
  constexpr double kMostOther = 0.02;  // of the area
  double area = 0.0;
  double other = 0.0;
  for (const Triangle& triangle : mesh.triangles) {
    const glm::vec3 across = acrossOf(mesh, triangle);
    const float length = glm::length(across);
    area += static_cast<double>(length);
    const bool isOfForm = std::ranges::all_of(triangle, [&](std::uint32_t corner) {
      return glm::dot(mesh.vertices[corner].normal, across) >= kMinCosine * length;
    });
    if (!isOfForm) other += static_cast<double>(length);
  }
  return other <= kMostOther * area;
}

bool hasOneColour(const Mesh& mesh) {
  return std::ranges::all_of(mesh.vertices, [&](const MeshVertex& vertex) {
    return vertex.colour == mesh.vertices.front().colour;
  });
}

bool isSimple(const Model& model, const Surface& surface) {
  const Mesh& mesh = surface.mesh;
  return !mesh.triangles.empty() && mesh.joints.empty() && mesh.morphTargets.empty() &&
         !model.materials[surface.material].texture && hasOneColour(mesh) &&
         hasNormalsOfItsForm(mesh);
}

/// Vertices that differ in nothing become one, and those that no triangle has go.
Mesh withoutSpareVertices(const Mesh& mesh) {
  std::vector<meshopt_Stream> streams{
      {mesh.vertices.data(), sizeof(MeshVertex), sizeof(MeshVertex)}};
  if (!mesh.tangents.empty()) {
    streams.push_back({mesh.tangents.data(), sizeof(glm::vec3), sizeof(glm::vec3)});
  }
  const std::uint32_t* indices = mesh.triangles.front().data();
  const std::size_t count = 3 * mesh.triangles.size();
  std::vector<std::uint32_t> places(mesh.vertices.size());
  Mesh made;
  made.vertices.resize(meshopt_generateVertexRemapMulti(
      places.data(), indices, count, mesh.vertices.size(), streams.data(), streams.size()));
  meshopt_remapVertexBuffer(made.vertices.data(), mesh.vertices.data(), mesh.vertices.size(),
                            sizeof(MeshVertex), places.data());
  if (!mesh.tangents.empty()) {
    made.tangents.resize(made.vertices.size());
    meshopt_remapVertexBuffer(made.tangents.data(), mesh.tangents.data(), mesh.tangents.size(),
                              sizeof(glm::vec3), places.data());
  }
  made.triangles.resize(mesh.triangles.size());
  meshopt_remapIndexBuffer(made.triangles.front().data(), indices, count, places.data());
  return made;
}

Mesh simplified(const Mesh& mesh, double maxErrorMetres) {
  Mesh made = withoutSpareVertices(mesh);
  const float* positions = &made.vertices.front().position.x;
  const double extent = meshopt_simplifyScale(positions, made.vertices.size(), sizeof(MeshVertex));
  if (!(extent > 0.0)) return mesh;
  std::vector<Triangle> fewer(made.triangles.size());
  const std::size_t count = meshopt_simplify(
      fewer.front().data(), made.triangles.front().data(), 3 * made.triangles.size(), positions,
      made.vertices.size(), sizeof(MeshVertex), 0,
      static_cast<float>(kMeanOfLargest * maxErrorMetres / extent), 0, nullptr);
  if (count == 0 || count >= 3 * made.triangles.size()) return mesh;
  fewer.resize(count / 3);
  made.triangles = std::move(fewer);
  return withoutSpareVertices(made);
}

}  // namespace

Model simplified(Model model) {
  const double ofModel = kErrorOfModel * 2.0 * boundingSphere(model).radiusMetres;
  const std::vector<double> scales = scalesAtRest(model);
  for (std::size_t i = 0; i < model.surfaces.size(); ++i) {
    Surface& surface = model.surfaces[i];
    if (!(scales[i] > 0.0) || !isSimple(model, surface)) continue;
    const double ofSurface = kErrorOfSurface * 2.0 * model.bounds[i].sphere.radiusMetres;
    surface.mesh = simplified(surface.mesh, std::min(ofModel / scales[i], ofSurface));
  }
  numberParts(model);
  return model;
}

}  // namespace pleinair::scene
