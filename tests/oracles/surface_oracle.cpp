#include "tests/oracles/surface_oracle.h"

#include <array>
#include <cmath>
#include <stdexcept>

#include <glm/geometric.hpp>

namespace pleinair::oracles {
namespace {

TrianglePoint triangleOf(const scene::Model& model, std::uint32_t number) {
  for (std::size_t p = 0; p < model.parts.size(); ++p) {
    std::size_t left = number - model.parts[p].firstTriangle;
    if (number < model.parts[p].firstTriangle || left >= model.parts[p].triangleCount) continue;
    for (std::size_t s = 0; s < model.parts[p].surfaceCount; ++s) {
      const auto& mesh = model.surfaces[model.parts[p].firstSurface + s].mesh;
      if (left < mesh.triangles.size()) return {.part = p, .surface = s, .triangle = left};
      left -= mesh.triangles.size();
    }
  }
  throw std::out_of_range("no such triangle");
}

const scene::Mesh& meshOf(const scene::Model& model, const TrianglePoint& point) {
  return model.surfaces[model.parts[point.part].firstSurface + point.surface].mesh;
}

std::array<glm::dvec3, 3> cameraCorners(const PosedModel& posed, const TrianglePoint& point) {
  std::array<glm::dvec3, 3> corners{};
  const auto& triangle = meshOf(*posed.model, point).triangles[point.triangle];
  for (std::size_t i = 0; i < 3; ++i) {
    const scene::MeshVertex vertex = scene::posedVertex(
        *posed.model, posed.model->parts[point.part], point.surface, triangle[i], posed.pose);
    corners[i] = glm::dvec3(posed.cameraFromModel * glm::dvec4(glm::dvec3(vertex.position), 1.0));
  }
  return corners;
}

double cross(glm::dvec2 a, glm::dvec2 b) {
  return a.x * b.y - a.y * b.x;
}

}  // namespace

std::optional<TrianglePoint> pointBehind(const PosedModel& posed, std::uint32_t triangle,
                                         const tracking::CameraModel& camera, glm::dvec2 px) {
  TrianglePoint point = triangleOf(*posed.model, triangle);
  const auto corners = cameraCorners(posed, point);
  std::array<glm::dvec2, 3> seen{};
  for (std::size_t i = 0; i < 3; ++i) seen[i] = camera.project(corners[i]);
  const double area = cross(seen[1] - seen[0], seen[2] - seen[0]);
  if (std::abs(area) < 1e-9) return std::nullopt;
  // linear in the image, then each weighted by its inverse depth
  const glm::dvec3 flat(cross(seen[1] - px, seen[2] - px) / area,
                        cross(seen[2] - px, seen[0] - px) / area,
                        cross(seen[0] - px, seen[1] - px) / area);
  const glm::dvec3 weighted(flat.x / corners[0].z, flat.y / corners[1].z, flat.z / corners[2].z);
  point.barycentrics = weighted / (weighted.x + weighted.y + weighted.z);
  return point;
}

glm::dvec3 cameraPoint(const PosedModel& posed, const TrianglePoint& point) {
  const auto corners = cameraCorners(posed, point);
  return point.barycentrics.x * corners[0] + point.barycentrics.y * corners[1] +
         point.barycentrics.z * corners[2];
}

glm::dvec3 restPoint(const scene::Model& model, const TrianglePoint& point) {
  const scene::Mesh& mesh = meshOf(model, point);
  glm::dvec3 sum(0.0);
  for (int i = 0; i < 3; ++i) {
    const auto corner = mesh.triangles[point.triangle][static_cast<std::size_t>(i)];
    sum += point.barycentrics[i] * glm::dvec3(mesh.vertices[corner].position);
  }
  return sum;
}

}  // namespace pleinair::oracles
