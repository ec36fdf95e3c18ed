// withShortEdges() of mesh.h.
#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <cstdint>
#include <unordered_map>
#include <utility>
#include <vector>

#include <glm/geometric.hpp>

#include "pipeline/scene/mesh.h"

namespace pleinair::scene {
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

/// The mean of both, of its strongest four joints. The same from both sides, to the bit.
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

/// A mesh that grows as its edges are halved.
class EdgeCutter {
 public:
  EdgeCutter(const Mesh& mesh, float maxEdgeMetres, std::size_t mostTriangles)
      : result_(mesh), mostSquared_(maxEdgeMetres * maxEdgeMetres), mostTriangles_(mostTriangles) {
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
      std::size_t longest = 0;  // the edge from this corner to the next
      float longestSquared = 0.0F;
      for (std::size_t i = 0; i < 3; ++i) {
        const float squared = squaredLength(corners[i], corners[(i + 1) % 3]);
        if (squared > longestSquared) {
          longest = i;
          longestSquared = squared;
        }
      }
      if (longestSquared <= mostSquared_ ||
          result_.triangles.size() + pending_.size() >= mostTriangles_) {
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

  /// The vertex half way, made when it is first asked for.
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
    const auto mean = [](const glm::vec3& x, const glm::vec3& y) { return 0.5F * (x + y); };
    for (MorphTarget& target : result_.morphTargets) {
      addMiddle(target.positions, mean);
      addMiddle(target.normals, mean);
    }
    return entry->second;
  }

  Mesh result_;
  float mostSquared_;
  std::size_t mostTriangles_;
  std::vector<Triangle> pending_;
  std::unordered_map<std::uint64_t, std::uint32_t> middles_;  ///< of edges, lower end first
};

}  // namespace

Mesh withShortEdges(const Mesh& mesh, float maxEdgeMetres, std::size_t mostTriangles) {
  assert(maxEdgeMetres > 0.0F);
  return EdgeCutter(mesh, maxEdgeMetres, mostTriangles).cut(mesh.triangles);
}

}  // namespace pleinair::scene
