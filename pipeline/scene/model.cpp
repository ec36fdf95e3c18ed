#include "pipeline/scene/model.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <numbers>
#include <span>
#include <utility>

#include <glm/common.hpp>
#include <glm/ext/matrix_transform.hpp>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>

namespace pleinair::scene {
namespace {

std::span<const Surface> surfacesOf(const Model& model, const ModelPart& part) {
  return std::span(model.surfaces).subspan(part.firstSurface, part.surfaceCount);
}

/// At most so much longer an affine transform makes anything.
double largestScale(const glm::dmat4& transform) {
  double squares = 0.0;
  for (int column = 0; column < 3; ++column) {
    const glm::dvec3 axis(transform[column]);
    squares += glm::dot(axis, axis);
  }
  return std::sqrt(squares);  // the Frobenius norm; √3 too much for a plain rotation
}

bool isRotationAndScale(const glm::dmat4& transform) {
  const glm::dvec3 x(transform[0]);
  const glm::dvec3 y(transform[1]);
  const glm::dvec3 z(transform[2]);
  const double size = glm::dot(x, x);
  const auto isSmall = [&](double value) { return std::abs(value) <= 1e-6 * size; };
  return isSmall(glm::dot(y, y) - size) && isSmall(glm::dot(z, z) - size) &&
         isSmall(glm::dot(x, y)) && isSmall(glm::dot(y, z)) && isSmall(glm::dot(z, x));
}

double scaleOf(const glm::dmat4& transform) {
  return isRotationAndScale(transform) ? glm::length(glm::dvec3(transform[0]))
                                       : largestScale(transform);
}

/// In the model's frame.
BoundingSphere sweptSphere(const ModelPart& part, BoundingSphere sphere) {
  if (part.radiansPerSecond != 0.0) {  // its own z axis is what it turns about
    sphere.radiusMetres += glm::length(glm::dvec2(sphere.centre));
    sphere.centre.x = sphere.centre.y = 0.0;
  }
  return {.centre = glm::dvec3(part.modelFromPart * glm::dvec4(sphere.centre, 1.0)),
          .radiusMetres = scaleOf(part.modelFromPart) * sphere.radiusMetres};
}

}  // namespace

std::uint32_t Model::triangleCount() const {
  return parts.empty() ? 0 : parts.back().firstTriangle + parts.back().triangleCount;
}

std::size_t Model::surfaceTriangles() const {
  std::size_t count = 0;
  for (const Surface& surface : surfaces) count += surface.mesh.triangles.size();
  return count;
}

std::uint64_t drawnTriangles(const Model& model) {
  std::uint64_t count = 0;
  for (const ModelPart& part : model.parts) {
    for (const Surface& surface : surfacesOf(model, part)) count += surface.mesh.triangles.size();
  }
  return count;
}

void numberParts(Model& model) {
  std::uint32_t nextTriangle = 0;
  std::size_t nextMatrix = 0;
  std::size_t nextWeight = 0;
  for (ModelPart& part : model.parts) {
    part.firstTriangle = nextTriangle;
    part.firstMatrix = nextMatrix;
    part.matrixCount = part.skin ? model.rig.skins[*part.skin].joints.size() : 1;
    part.firstWeight = nextWeight;
    part.weightCount = 0;
    for (const Surface& surface : surfacesOf(model, part)) {
      nextTriangle += static_cast<std::uint32_t>(surface.mesh.triangles.size());
      part.weightCount = std::max(part.weightCount, surface.mesh.morphTargets.size());
    }
    part.triangleCount = nextTriangle - part.firstTriangle;
    nextMatrix += part.matrixCount;
    nextWeight += part.weightCount;
  }
}

Model singlePartModel(std::string name, Mesh mesh) {
  Model model;
  model.surfaces.push_back({.mesh = std::move(mesh)});
  model.materials.emplace_back();
  model.parts.push_back({.name = std::move(name), .surfaceCount = 1});
  numberParts(model);
  return model;
}

glm::dmat4 modelFromPart(const ModelPart& part, hal::Duration time) {
  if (part.radiansPerSecond == 0.0) return part.modelFromPart;
  const double seconds = std::chrono::duration<double>(time).count();
  const double angle = std::remainder(part.radiansPerSecond * seconds, 2.0 * std::numbers::pi);
  return glm::rotate(part.modelFromPart, angle, {0.0, 0.0, 1.0});
}

BoundingSphere boundingSphere(const Model& model) {
  std::vector<BoundingSphere> ofSurfaces;
  for (const Surface& surface : model.surfaces) ofSurfaces.push_back(boundingSphere(surface.mesh));
  std::vector<BoundingSphere> spheres;
  for (const ModelPart& part : model.parts) {
    for (std::size_t i = 0; i < part.surfaceCount; ++i) {
      const std::size_t surface = part.firstSurface + i;
      if (model.surfaces[surface].mesh.vertices.empty()) continue;
      spheres.push_back(sweptSphere(part, ofSurfaces[surface]));
    }
  }
  if (spheres.empty()) return {};
  glm::dvec3 low = spheres.front().centre;
  glm::dvec3 high = low;
  for (const BoundingSphere& sphere : spheres) {
    low = glm::min(low, sphere.centre - sphere.radiusMetres);
    high = glm::max(high, sphere.centre + sphere.radiusMetres);
  }
  BoundingSphere all{.centre = 0.5 * (low + high)};
  for (const BoundingSphere& sphere : spheres) {
    all.radiusMetres =
        std::max(all.radiusMetres, glm::distance(all.centre, sphere.centre) + sphere.radiusMetres);
  }
  return all;
}

const ModelPart* partOfTriangle(const Model& model, std::uint32_t triangle) {
  if (triangle >= model.triangleCount()) return nullptr;
  // Parts without triangles start where the next one does; the last that starts here has it.
  const auto after = std::ranges::upper_bound(model.parts, triangle, {}, &ModelPart::firstTriangle);
  return &*std::prev(after);
}

const ModelPart* findPart(const Model& model, std::string_view name) {
  const auto found = std::ranges::find(model.parts, name, &ModelPart::name);
  return found == model.parts.end() ? nullptr : &*found;
}

Model withShortEdges(const Model& model, double maxEdgeMetres, std::size_t mostTriangles) {
  Model result = model;
  std::vector<double> scales(model.surfaces.size(), 0.0);
  for (const ModelPart& part : model.parts) {
    for (std::size_t i = 0; i < part.surfaceCount; ++i) {
      double& scale = scales[part.firstSurface + i];
      scale = std::max(scale, scaleOf(part.modelFromPart));
    }
  }
  for (std::size_t i = 0; i < scales.size(); ++i) {
    const auto edge = static_cast<float>(maxEdgeMetres / scales[i]);
    if (!(scales[i] > 0.0) || !(edge > 0.0F)) continue;
    result.surfaces[i].mesh = withShortEdges(model.surfaces[i].mesh, edge, mostTriangles);
    mostTriangles -= std::min(mostTriangles, result.surfaces[i].mesh.triangles.size());
  }
  numberParts(result);
  return result;
}

}  // namespace pleinair::scene
