#include "pipeline/scene/models/model.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <numbers>
#include <span>
#include <utility>

#include <glm/common.hpp>
#include <glm/ext/matrix_transform.hpp>
#include <glm/geometric.hpp>

#include "pipeline/scene/models/mesh.h"
#include "pipeline/scene/models/model_pose.h"

namespace pleinair::scene {
namespace {

std::span<const Surface> surfacesOf(const Model& model, const ModelPart& part) {
  return std::span(model.surfaces).subspan(part.firstSurface, part.surfaceCount);
}

/// Limits the memory of morph targets of subdivided surfaces: triangles times targets times parts.
constexpr std::size_t kMaxSubdividedMorphs = 4'000'000;

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
  model.bounds.clear();
  for (const Surface& surface : model.surfaces) model.bounds.push_back(boundsOf(surface.mesh));
}

Model singlePartModel(std::string name, Mesh mesh) {
  Model model;
  model.surfaces.push_back({.mesh = std::move(mesh)});
  model.materials.emplace_back();
  model.parts.push_back({.name = std::move(name), .surfaceCount = 1});
  numberParts(model);
  return model;
}

glm::dmat4 turnedAfter(const ModelPart& part, hal::Duration time) {
  const double seconds = hal::toSeconds(time);
  const double angle = std::remainder(part.radiansPerSecond * seconds, 2.0 * std::numbers::pi);
  return glm::rotate(glm::dmat4(1.0), angle, {0.0, 0.0, 1.0});
}

glm::dmat4 modelFromPart(const ModelPart& part, hal::Duration time) {
  if (part.radiansPerSecond == 0.0) return part.modelFromPart;
  return part.modelFromPart * turnedAfter(part, time);
}

const ModelPart* partOfTriangle(const Model& model, std::uint32_t triangle) {
  if (triangle >= model.triangleCount()) return nullptr;
  // A part without triangles starts where the next one does; the last part that starts here has it.
  const auto after = std::ranges::upper_bound(model.parts, triangle, {}, &ModelPart::firstTriangle);
  return &*std::prev(after);
}

const ModelPart* findPart(const Model& model, std::string_view name) {
  const auto found = std::ranges::find(model.parts, name, &ModelPart::name);
  return found == model.parts.end() ? nullptr : &*found;
}

std::vector<double> scalesAtRest(const Model& model) {
  ModelPose rest;
  poseModel(model, std::nullopt, hal::Duration::zero(), rest);
  std::vector<double> scales(model.surfaces.size(), 0.0);
  for (const ModelPart& part : model.parts) {
    for (std::size_t i = part.firstSurface; i < part.firstSurface + part.surfaceCount; ++i) {
      if (!part.skin) {
        scales[i] = std::max(scales[i], largestScale(rest.matrices[part.firstMatrix]));
        continue;
      }
      for (const JointBounds& joint : model.bounds[i].joints) {
        scales[i] =
            std::max(scales[i], largestScale(rest.matrices[part.firstMatrix + joint.joint]));
      }
    }
  }
  return scales;
}

Model withShortEdges(const Model& model, double maxEdgeMetres, std::size_t maxTriangles) {
  Model result = model;
  const std::vector<double> scales = scalesAtRest(model);
  std::vector<std::size_t> uses(model.surfaces.size(), 0);
  for (const ModelPart& part : model.parts) {
    for (std::size_t i = 0; i < part.surfaceCount; ++i) ++uses[part.firstSurface + i];
  }
  std::size_t maxMorphs = kMaxSubdividedMorphs;
  for (std::size_t i = 0; i < scales.size(); ++i) {
    const auto edge = static_cast<float>(maxEdgeMetres / scales[i]);
    if (!(scales[i] > 0.0) || !(edge > 0.0F)) continue;
    Mesh& mesh = result.surfaces[i].mesh;
    const std::size_t morphs = mesh.morphTargets.size() * uses[i];
    const std::size_t max = morphs > 0 ? std::min(maxTriangles, maxMorphs / morphs) : maxTriangles;
    mesh = withShortEdges(mesh, edge, max);
    maxTriangles -= std::min(maxTriangles, mesh.triangles.size());
    maxMorphs -= std::min(maxMorphs, morphs * mesh.triangles.size());
  }
  numberParts(result);
  return result;
}

// Bounding spheres of models at rest (model.h) and posed (model_pose.h).
namespace {

/// The reach of a surface's vertices under morph targets: each moves by a vector in this box.
struct MorphReach {
  glm::dvec3 middle{0.0};
  double radiusMetres = 0.0;

  BoundingSphere around(const BoundingSphere& sphere) const {
    return {.centre = sphere.centre + middle, .radiusMetres = sphere.radiusMetres + radiusMetres};
  }
};

MorphReach morphReach(const SurfaceBounds& bounds, const ModelPart& part, const ModelPose& pose) {
  glm::dvec3 middle(0.0);
  glm::dvec3 half(0.0);
  for (std::size_t i = 0; i < bounds.morphs.size(); ++i) {
    const auto weight = static_cast<double>(pose.weights[part.firstWeight + i]);
    const glm::dvec3 min(bounds.morphs[i].min);
    const glm::dvec3 max(bounds.morphs[i].max);
    middle += 0.5 * weight * (min + max);
    half += 0.5 * std::abs(weight) * (max - min);
  }
  return {.middle = middle, .radiusMetres = glm::length(half)};
}

/// A sphere around everything that a sphere passes while it turns about its own z axis.
BoundingSphere sweptAboutZ(BoundingSphere sphere) {
  sphere.radiusMetres += glm::length(glm::dvec2(sphere.centre));
  sphere.centre.x = sphere.centre.y = 0.0;
  return sphere;
}

/// Calls `visit(sphere)` with spheres that together hold all vertices, in the model's frame.
/// `sweeps`: over the whole rotation of turning parts.
template <class Visit>
void forEachSphere(const Model& model, const ModelPose& pose, bool sweeps, Visit visit) {
  assert(model.bounds.size() == model.surfaces.size());
  for (const ModelPart& part : model.parts) {
    // A hidden part shrinks to a point, which is no place of the model
    // (PosedGeometry::hideParts()).
    if (pose.matrices[part.firstMatrix] == glm::dmat4(0.0)) continue;
    for (std::size_t i = 0; i < part.surfaceCount; ++i) {
      if (model.surfaces[part.firstSurface + i].mesh.vertices.empty()) continue;
      const SurfaceBounds& bounds = model.bounds[part.firstSurface + i];
      const MorphReach reach = morphReach(bounds, part, pose);
      if (!part.skin) {
        BoundingSphere sphere = reach.around(bounds.sphere);
        if (sweeps && part.radiansPerSecond != 0.0) sphere = sweptAboutZ(sphere);
        visit(transformed(sphere, pose.matrices[part.firstMatrix]));
        continue;
      }
      // A vertex is a mean of its positions under its joints, so it lies within the bounds of all
      // of these.
      for (const JointBounds& joint : bounds.joints) {
        const BoundingSphere held{.centre = glm::dvec3(joint.centre),
                                  .radiusMetres = static_cast<double>(joint.radiusMetres)};
        visit(transformed(reach.around(held), pose.matrices[part.firstMatrix + joint.joint]));
      }
    }
  }
}

/// Around the centre of the box that holds all spheres.
BoundingSphere sphereAroundAll(const Model& model, const ModelPose& pose, bool sweeps) {
  bool isEmpty = true;
  glm::dvec3 low(0.0);
  glm::dvec3 high(0.0);
  forEachSphere(model, pose, sweeps, [&](const BoundingSphere& sphere) {
    const glm::dvec3 min = sphere.centre - sphere.radiusMetres;
    const glm::dvec3 max = sphere.centre + sphere.radiusMetres;
    low = isEmpty ? min : glm::min(low, min);
    high = isEmpty ? max : glm::max(high, max);
    isEmpty = false;
  });
  BoundingSphere all{.centre = 0.5 * (low + high)};
  forEachSphere(model, pose, sweeps, [&](const BoundingSphere& sphere) {
    all.radiusMetres =
        std::max(all.radiusMetres, glm::distance(all.centre, sphere.centre) + sphere.radiusMetres);
  });
  return all;
}

}  // namespace

BoundingSphere boundingSphere(const Model& model) {
  ModelPose rest;
  poseModel(model, std::nullopt, hal::Duration::zero(), rest);
  return sphereAroundAll(model, rest, true);
}

void boundingSpheres(const Model& model, const ModelPose& pose,
                     std::vector<BoundingSphere>& spheres) {
  spheres.clear();
  forEachSphere(model, pose, false,
                [&](const BoundingSphere& sphere) { spheres.push_back(sphere); });
}

BoundingSphere boundingSphere(const Model& model, const ModelPose& pose) {
  return sphereAroundAll(model, pose, false);
}

}  // namespace pleinair::scene
