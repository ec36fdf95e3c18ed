#include "pipeline/scene/models/surface_bounds.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace pleinair::scene {
namespace {

MorphBounds boundsOf(const MorphTarget& target) {
  MorphBounds bounds;  // include 0, since most targets leave some vertex unmoved
  for (const glm::vec3& move : target.positions) {
    bounds.min = glm::min(bounds.min, move);
    bounds.max = glm::max(bounds.max, move);
  }
  return bounds;
}

/// Calls `visit(joint, position)` for each vertex and each joint that holds it.
template <class Visit>
void forEachJointVertex(const Mesh& mesh, Visit visit) {
  for (std::size_t i = 0; i < mesh.joints.size(); ++i) {
    for (std::size_t j = 0; j < 4; ++j) {
      if (mesh.joints[i].weights[j] > 0.0F) {
        visit(mesh.joints[i].joints[j], mesh.vertices[i].position);
      }
    }
  }
}

std::vector<JointBounds> jointBoundsOf(const Mesh& mesh) {
  struct Box {
    glm::vec3 low{std::numeric_limits<float>::max()};
    glm::vec3 high{std::numeric_limits<float>::lowest()};
  };
  std::vector<Box> boxes;
  forEachJointVertex(mesh, [&](std::uint16_t joint, const glm::vec3& position) {
    if (boxes.size() <= joint) boxes.resize(joint + std::size_t{1});
    boxes[joint].low = glm::min(boxes[joint].low, position);
    boxes[joint].high = glm::max(boxes[joint].high, position);
  });
  std::vector<JointBounds> bounds;
  std::vector<std::size_t> placeOfJoint(boxes.size(), 0);
  for (std::size_t joint = 0; joint < boxes.size(); ++joint) {
    if (boxes[joint].low.x > boxes[joint].high.x) continue;
    placeOfJoint[joint] = bounds.size();
    bounds.push_back({.joint = static_cast<std::uint16_t>(joint),
                      .centre = 0.5F * (boxes[joint].low + boxes[joint].high)});
  }
  forEachJointVertex(mesh, [&](std::uint16_t joint, const glm::vec3& position) {
    JointBounds& of = bounds[placeOfJoint[joint]];
    of.radiusMetres = std::max(of.radiusMetres, glm::distance(of.centre, position));
  });
  for (JointBounds& of : bounds) of.radiusMetres *= 1.0F + 1e-6F;  // for rounding
  return bounds;
}

}  // namespace

SurfaceBounds boundsOf(const Mesh& mesh) {
  SurfaceBounds bounds{.sphere = boundingSphere(mesh)};
  for (const MorphTarget& target : mesh.morphTargets) bounds.morphs.push_back(boundsOf(target));
  bounds.joints = jointBoundsOf(mesh);
  return bounds;
}

}  // namespace pleinair::scene
