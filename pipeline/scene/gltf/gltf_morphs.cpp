#include "pipeline/scene/gltf/gltf_morphs.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include "pipeline/scene/gltf/gltf_fault.h"
#include "pipeline/scene/gltf/gltf_limits.h"
#include "pipeline/scene/models/rig.h"

namespace pleinair::scene::gltf {
namespace {

const tinygltf::Mesh* meshOf(const tinygltf::Model& gltf, std::size_t node) {
  const int mesh = gltf.nodes[node].mesh;
  const bool isThere = mesh >= 0 && static_cast<std::size_t>(mesh) < gltf.meshes.size();
  return isThere ? &gltf.meshes[static_cast<std::size_t>(mesh)] : nullptr;
}

std::vector<glm::vec3> movesOf(const std::vector<glm::vec4>& elements) {
  std::vector<glm::vec3> moves;
  moves.reserve(elements.size());
  for (const glm::vec4& element : elements) moves.emplace_back(element);
  return moves;
}

}  // namespace

std::size_t morphTargetsOf(const tinygltf::Model& gltf, std::size_t node) {
  const tinygltf::Mesh* mesh = meshOf(gltf, node);
  if (mesh == nullptr || mesh->primitives.empty()) return 0;
  const std::size_t count = mesh->primitives.front().targets.size();
  if (count > kMaxMorphTargets) {
    refuseUnsupported(fmt::format("meshes[{}].primitives[0].targets", gltf.nodes[node].mesh),
                      fmt::format("has {} morph targets", count),
                      fmt::format("at most {}", kMaxMorphTargets));
  }
  return count;
}

void checkMorphTargets(const tinygltf::Mesh& mesh, const std::string& name) {
  for (std::size_t i = 0; i < mesh.primitives.size(); ++i) {
    const std::size_t count = mesh.primitives.front().targets.size();
    const std::size_t own = mesh.primitives[i].targets.size();
    if (own == count) continue;
    refuse(fmt::format("{}.primitives[{}].targets", name, i),
           fmt::format("has {}, primitives[0] {}", own, count));
  }
}

std::vector<float> restWeightsOf(const tinygltf::Model& gltf, std::size_t node) {
  const std::size_t count = morphTargetsOf(gltf, node);
  std::vector<float> weights(count, 0.0F);
  if (count == 0) return weights;
  const bool isNodes = !gltf.nodes[node].weights.empty();
  const std::vector<double>& given =
      isNodes ? gltf.nodes[node].weights : meshOf(gltf, node)->weights;
  if (given.empty()) return weights;
  const std::string where = isNodes ? fmt::format("nodes[{}].weights", node)
                                    : fmt::format("meshes[{}].weights", gltf.nodes[node].mesh);
  if (given.size() != count) {
    refuse(where, fmt::format("has {}, of {} morph targets", given.size(), count));
  }
  for (std::size_t i = 0; i < count; ++i) {
    if (!(std::abs(given[i]) <= kMaxCoordinate)) {
      refuse(where, fmt::format("found {}", given[i]),
             fmt::format("numbers of at most {}", kMaxCoordinate));
    }
    weights[i] = static_cast<float>(given[i]);
  }
  return weights;
}

std::vector<MorphTarget> MorphReader::read(const tinygltf::Primitive& primitive,
                                           std::size_t vertices, std::size_t kept,
                                           const std::string& where) {
  moves_ += 2 * primitive.targets.size() * std::max(vertices, kept);
  if (moves_ > kMaxMorphMoves) {
    refuse(where + ".targets", "exceed the total number of vertex offsets",
           fmt::format("at most {} in all", kMaxMorphMoves));
  }
  std::vector<MorphTarget> targets;
  for (const auto& attributes : primitive.targets) {
    const auto moves = [&](const char* name) {
      const auto found = attributes.find(name);
      if (found == attributes.end()) return std::vector<glm::vec3>();
      const std::string place = fmt::format("{}.targets[{}].{}", where, targets.size(), name);
      auto read = movesOf(accessors_.vectors(found->second, place));
      if (read.size() != vertices) {
        refuse(place, fmt::format("has {} elements, POSITION {}", read.size(), vertices));
      }
      return read;
    };
    MorphTarget target{.positions = moves("POSITION")};
    if (target.positions.empty()) target.positions.resize(vertices, glm::vec3(0.0F));
    // without normals the mesh is flat, and the target's are left out (section 3.7.2.2)
    if (primitive.attributes.contains("NORMAL")) target.normals = moves("NORMAL");
    hasOthers_ =
        hasOthers_ || std::ranges::any_of(attributes, [](const auto& attribute) {
          return attribute.first.starts_with("COLOR_") || attribute.first.starts_with("TEXCOORD_");
        });
    targets.push_back(std::move(target));
  }
  return targets;
}

void addFlatNormals(Mesh& mesh) {
  for (MorphTarget& target : mesh.morphTargets) {
    target.normals.assign(mesh.vertices.size(), glm::vec3(0.0F));
    for (const auto& triangle : mesh.triangles) {
      const auto corner = [&](std::size_t i) {
        return glm::dvec3(mesh.vertices[triangle[i]].position) +
               glm::dvec3(target.positions[triangle[i]]);
      };
      const glm::dvec3 area = glm::cross(corner(1) - corner(0), corner(2) - corner(0));
      const double size = glm::length(area);
      if (!(size > 0.0)) continue;
      for (const std::uint32_t vertex : triangle) {
        target.normals[vertex] = glm::vec3(area / size - glm::dvec3(mesh.vertices[vertex].normal));
      }
    }
  }
}

}  // namespace pleinair::scene::gltf
