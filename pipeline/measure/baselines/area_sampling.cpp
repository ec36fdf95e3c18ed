#include "pipeline/measure/baselines/area_sampling.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>

#include <glm/geometric.hpp>

namespace pleinair::measure {

std::vector<Triangle> trianglesOf(const scene::Model& model, const scene::ModelPose& pose,
                                  const glm::dmat4& frameFromModel) {
  std::vector<Triangle> triangles;
  for (const scene::ModelPart& part : model.parts) {
    for (std::size_t surface = 0; surface < part.surfaceCount; ++surface) {
      const scene::Mesh& mesh = model.surfaces[part.firstSurface + surface].mesh;
      std::vector<glm::dvec3> places;
      places.reserve(mesh.vertices.size());
      for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
        const scene::MeshVertex vertex = posedVertex(model, part, surface, i, pose);
        places.emplace_back(frameFromModel * glm::dvec4(glm::dvec3(vertex.position), 1.0));
      }
      for (const auto& corners : mesh.triangles) {
        triangles.push_back({places[corners[0]], places[corners[1]], places[corners[2]]});
      }
    }
  }
  return triangles;
}

std::vector<SurfaceSample> sampleByArea(std::span<const Triangle> triangles, std::size_t count,
                                        unsigned seed) {
  std::vector<double> areas;
  areas.reserve(triangles.size());
  for (const auto& [a, b, c] : triangles) {
    areas.push_back(0.5 * glm::length(glm::cross(b - a, c - a)));
  }
  std::vector<double> sums(areas.size());
  std::partial_sum(areas.begin(), areas.end(), sums.begin());  // eq. 20-21, not yet normalised
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> ofArea(0.0, sums.back());
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  std::vector<SurfaceSample> samples;
  samples.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    const auto found = std::ranges::upper_bound(sums, ofArea(random));
    const auto triangle = std::min<std::ptrdiff_t>(found - sums.begin(), std::ssize(sums) - 1);
    const double root = std::sqrt(unit(random));
    const double v = unit(random);
    samples.push_back({.triangle = static_cast<std::uint32_t>(triangle),
                       .barycentrics = {1.0 - root, root * (1.0 - v), root * v}});
  }
  return samples;
}

}  // namespace pleinair::measure
