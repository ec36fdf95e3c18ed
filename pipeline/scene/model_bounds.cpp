// Spheres around models, at rest (model.h) and posed (model_pose.h).
#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstddef>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "pipeline/scene/affine.h"
#include "pipeline/scene/model.h"
#include "pipeline/scene/model_pose.h"

namespace pleinair::scene {
namespace {

/// Where morph targets may have taken the vertices of a surface: each by some move of this box.
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
    const glm::dvec3 least(bounds.morphs[i].least);
    const glm::dvec3 most(bounds.morphs[i].most);
    middle += 0.5 * weight * (least + most);
    half += 0.5 * std::abs(weight) * (most - least);
  }
  return {.middle = middle, .radiusMetres = glm::length(half)};
}

/// Around all that it turns through: its own z axis is what it turns about.
BoundingSphere sweptAboutZ(BoundingSphere sphere) {
  sphere.radiusMetres += glm::length(glm::dvec2(sphere.centre));
  sphere.centre.x = sphere.centre.y = 0.0;
  return sphere;
}

/// Calls `visit(sphere)` with spheres that hold all vertices together, in the model's frame.
/// `sweeps`: also wherever turning parts turn to.
template <class Visit>
void forEachSphere(const Model& model, const ModelPose& pose, bool sweeps, Visit visit) {
  assert(model.bounds.size() == model.surfaces.size());
  for (const ModelPart& part : model.parts) {
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
      // A vertex is a mean of where its joints take it, so within what holds all of these.
      for (const JointBounds& joint : bounds.joints) {
        const BoundingSphere held{.centre = glm::dvec3(joint.centre),
                                  .radiusMetres = static_cast<double>(joint.radiusMetres)};
        visit(transformed(reach.around(held), pose.matrices[part.firstMatrix + joint.joint]));
      }
    }
  }
}

/// About the middle of the box that holds all spheres.
BoundingSphere sphereAroundAll(const Model& model, const ModelPose& pose, bool sweeps) {
  bool isEmpty = true;
  glm::dvec3 low(0.0);
  glm::dvec3 high(0.0);
  forEachSphere(model, pose, sweeps, [&](const BoundingSphere& sphere) {
    const glm::dvec3 least = sphere.centre - sphere.radiusMetres;
    const glm::dvec3 most = sphere.centre + sphere.radiusMetres;
    low = isEmpty ? least : glm::min(low, least);
    high = isEmpty ? most : glm::max(high, most);
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
