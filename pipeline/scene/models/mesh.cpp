#include "pipeline/scene/models/mesh.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <cstdint>
#include <limits>
#include <unordered_map>
#include <utility>
#include <vector>

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

namespace {

using Triangle = std::array<std::uint32_t, 3>;

MeshVertex midpoint(const MeshVertex& a, const MeshVertex& b) {
  const glm::vec3 sum = a.normal + b.normal;
  const float length = glm::length(sum);
  return {.position = 0.5F * (a.position + b.position),
          .normal = length > 1e-6F ? sum / length : a.normal,
          .texture = 0.5F * (a.texture + b.texture),
          .colour = 0.5F * (a.colour + b.colour)};
}

/// The mean of both, reduced to its four strongest joints. Exactly the same from both sides.
JointWeights midpoint(const JointWeights& a, const JointWeights& b) {
  std::array<std::pair<float, std::uint16_t>, 8> holds{};  // weight and joint
  std::size_t count = 0;
  for (const JointWeights* from : {&a, &b}) {
    for (std::size_t i = 0; i < 4; ++i) {
      if (!(from->weights[i] > 0.0F)) continue;
      const auto end = holds.begin() + static_cast<std::ptrdiff_t>(count);
      const auto known = std::find_if(
          holds.begin(), end, [&](const auto& hold) { return hold.second == from->joints[i]; });
      if (known == end) holds[count++] = {0.0F, from->joints[i]};
      known->first += 0.5F * from->weights[i];
    }
  }
  const auto isWeaker = [](const auto& one, const auto& other) {
    return one.first != other.first ? one.first < other.first : one.second > other.second;
  };
  JointWeights middle{.weights = {}};
  float sum = 0.0F;
  for (std::size_t i = 0; i < 4; ++i) {
    const auto strongest = std::ranges::max_element(holds, isWeaker);
    middle.joints[i] = strongest->second;
    middle.weights[i] = strongest->first;
    sum += strongest->first;
    *strongest = {};
  }
  if (!(sum > 0.0F)) return {};
  for (float& weight : middle.weights) weight /= sum;
  return middle;
}

/// A mesh that grows while its edges are halved.
class EdgeCutter {
 public:
  EdgeCutter(const Mesh& mesh, float maxEdgeMetres, std::size_t maxTriangles)
      : result_(mesh), maxSquared_(maxEdgeMetres * maxEdgeMetres), maxTriangles_(maxTriangles) {
    result_.triangles.clear();
  }

  Mesh cut(const std::vector<Triangle>& triangles) {
    for (const Triangle& triangle : triangles) cut(triangle);
    return std::move(result_);
  }

 private:
  void cut(const Triangle& whole) {
    pending_.push_back(whole);
    while (!pending_.empty()) {
      const Triangle corners = pending_.back();
      pending_.pop_back();
      std::size_t longest = 0;  // the longest edge starts at this corner
      float longestSquared = 0.0F;
      for (std::size_t i = 0; i < 3; ++i) {
        const float squared = squaredLength(corners[i], corners[(i + 1) % 3]);
        if (squared > longestSquared) {
          longest = i;
          longestSquared = squared;
        }
      }
      if (longestSquared <= maxSquared_ ||
          result_.triangles.size() + pending_.size() >= maxTriangles_) {
        result_.triangles.push_back(corners);
        continue;
      }
      const std::uint32_t a = corners[longest];
      const std::uint32_t b = corners[(longest + 1) % 3];
      const std::uint32_t c = corners[(longest + 2) % 3];
      const std::uint32_t middle = middleOf(a, b);
      pending_.push_back({middle, b, c});
      pending_.push_back({a, middle, c});
    }
  }

  float squaredLength(std::uint32_t a, std::uint32_t b) const {
    const glm::vec3 edge = result_.vertices[a].position - result_.vertices[b].position;
    return glm::dot(edge, edge);
  }

  /// The vertex in the middle of an edge, created on first use.
  std::uint32_t middleOf(std::uint32_t a, std::uint32_t b) {
    if (a > b) std::swap(a, b);
    const auto [entry, isNew] = middles_.try_emplace(
        std::uint64_t{a} << 32U | b, static_cast<std::uint32_t>(result_.vertices.size()));
    if (!isNew) return entry->second;
    const auto addMiddle = [&](auto& each, const auto& half) {
      if (!each.empty()) each.push_back(half(each[a], each[b]));
    };
    addMiddle(result_.vertices, [](const auto& x, const auto& y) { return midpoint(x, y); });
    addMiddle(result_.joints, [](const auto& x, const auto& y) { return midpoint(x, y); });
    addMiddle(result_.tangents, [](const glm::vec3& x, const glm::vec3& y) {
      return glm::dot(x, y) < 0.0F ? x - y : x + y;  // lines without a sign
    });
    const auto mean = [](const glm::vec3& x, const glm::vec3& y) { return 0.5F * (x + y); };
    for (MorphTarget& target : result_.morphTargets) {
      addMiddle(target.positions, mean);
      addMiddle(target.normals, mean);
    }
    return entry->second;
  }

  Mesh result_;
  float maxSquared_;
  std::size_t maxTriangles_;
  std::vector<Triangle> pending_;
  std::unordered_map<std::uint64_t, std::uint32_t> middles_;  ///< per edge, lower end first
};

}  // namespace

Mesh withShortEdges(const Mesh& mesh, float maxEdgeMetres, std::size_t maxTriangles) {
  assert(maxEdgeMetres > 0.0F);
  return EdgeCutter(mesh, maxEdgeMetres, maxTriangles).cut(mesh.triangles);
}

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
