#include "pipeline/scene/gltf/gltf_skins.h"

#include <algorithm>
#include <limits>

#include <fmt/format.h>

#include "config/config_error.h"
#include "pipeline/scene/gltf/gltf_fault.h"
#include "pipeline/scene/gltf/gltf_limits.h"

namespace pleinair::scene::gltf {
namespace {

/// Collects the four strongest joint weights of a vertex.
struct Strongest {
  std::array<std::uint32_t, 4> joints{};
  std::array<float, 4> weights{};
  float others = 0.0F;

  void add(std::uint32_t joint, float weight) {
    const auto weakest =
        static_cast<std::size_t>(std::ranges::min_element(weights) - weights.begin());
    if (weight <= weights[weakest]) {
      others += weight;
      return;
    }
    others += weights[weakest];
    joints[weakest] = joint;
    weights[weakest] = weight;
  }
};

/// Reads JOINTS_set and WEIGHTS_set; returns false if the primitive has none.
bool readSet(Accessors& accessors, const tinygltf::Primitive& primitive, int set,
             const std::string& where, std::vector<Strongest>& holds) {
  const auto jointsEntry = primitive.attributes.find(fmt::format("JOINTS_{}", set));
  const auto weightsEntry = primitive.attributes.find(fmt::format("WEIGHTS_{}", set));
  const auto none = primitive.attributes.end();
  if (jointsEntry == none || weightsEntry == none) return false;
  const std::string jointsWhere = where + ".attributes." + jointsEntry->first;
  const std::string weightsWhere = where + ".attributes." + weightsEntry->first;
  const auto joints = accessors.integers(jointsEntry->second, jointsWhere);
  const auto weights = accessors.vectors(weightsEntry->second, weightsWhere);
  const auto checkCount = [&](std::size_t found, const std::string& place) {
    if (found != holds.size()) {
      refuse(place, fmt::format("has {} elements, POSITION {}", found, holds.size()));
    }
  };
  checkCount(joints.size(), jointsWhere);
  checkCount(weights.size(), weightsWhere);
  for (std::size_t i = 0; i < holds.size(); ++i) {
    for (int c = 0; c < 4; ++c) {
      if (weights[i][c] > 0.0F) holds[i].add(joints[i][c], weights[i][c]);
    }
  }
  return true;
}

JointWeights normalised(const Strongest& holds, const std::string& where) {
  float sum = 0.0F;
  for (const float weight : holds.weights) sum += weight;
  if (!(sum > 0.0F)) return {};  // no joint holds it: the first one does
  JointWeights result;
  for (std::size_t i = 0; i < 4; ++i) {
    if (holds.weights[i] > 0.0F && holds.joints[i] >= kMaxJoints) {
      refuse(where + ".attributes", fmt::format("found joint {}", holds.joints[i]),
             fmt::format("at most {}", kMaxJoints - 1));
    }
    const bool holdsIt = holds.weights[i] > 0.0F;
    result.joints[i] = holdsIt ? static_cast<std::uint16_t>(holds.joints[i]) : std::uint16_t{0};
    result.weights[i] = holds.weights[i] / sum;
  }
  return result;
}

}  // namespace

std::size_t SkinReader::place(int index, std::vector<Skin>& skins, const std::string& where) {
  const auto known = places_.find(index);
  if (known != places_.end()) return known->second;
  const auto& all = structure_.gltf.skins;
  if (index < 0 || static_cast<std::size_t>(index) >= all.size()) {
    refuse(where, fmt::format("there is no skins[{}]", index));
  }
  skins.push_back(read(all[static_cast<std::size_t>(index)], fmt::format("skins[{}]", index)));
  places_.emplace(index, skins.size() - 1);
  return skins.size() - 1;
}

Skin SkinReader::read(const tinygltf::Skin& skin, const std::string& name) {
  if (skin.joints.empty()) refuse(name + ".joints", "is empty");
  if (skin.joints.size() > tree_.rig.size()) {  // each node at most once (section 5.28)
    refuse(name + ".joints",
           fmt::format("has {}, of {} nodes", skin.joints.size(), tree_.rig.size()));
  }
  if (skin.joints.size() > kMaxJoints) {
    const std::string own = skin.name.empty() ? "" : " " + config::quoted(oneLine(skin.name));
    refuseUnsupported(name + ".joints", fmt::format("the skin{} has {}", own, skin.joints.size()),
                      fmt::format("at most {} joints a skin", kMaxJoints));
  }
  Skin result;
  result.jointFromMesh.resize(skin.joints.size(), glm::dmat4(1.0));
  if (skin.inverseBindMatrices != -1) {
    auto given = accessors_.matrices(skin.inverseBindMatrices, name + ".inverseBindMatrices");
    if (given.size() < skin.joints.size()) {
      refuse(name + ".inverseBindMatrices",
             fmt::format("has {} of {}", given.size(), skin.joints.size()));
    }
    given.resize(skin.joints.size());
    result.jointFromMesh = std::move(given);
  }
  for (std::size_t i = 0; i < skin.joints.size(); ++i) {
    const int node = skin.joints[i];
    const std::string where = fmt::format("{}.joints[{}]", name, i);
    if (node < 0 || static_cast<std::size_t>(node) >= tree_.rig.size()) {
      refuse(where, fmt::format("there is no nodes[{}]", node));
    }
    glm::dmat4& jointFromMesh = result.jointFromMesh[i];
    for (int column = 0; column < 4; ++column) {  // the last row is 0 0 0 1
      jointFromMesh[column][3] = column == 3 ? 1.0 : 0.0;
    }
    if (!isBounded(tree_.rootFromNode[static_cast<std::size_t>(node)] * jointFromMesh)) {
      refuse(where, "has values out of range");
    }
    result.joints.push_back(tree_.rigIndex[static_cast<std::size_t>(node)]);
  }
  return result;
}

VertexJoints readJointWeights(Accessors& accessors, const tinygltf::Primitive& primitive,
                              std::size_t vertices, const std::string& where) {
  std::vector<Strongest> holds(vertices);
  int set = 0;
  while (readSet(accessors, primitive, set, where, holds)) ++set;
  VertexJoints result;
  result.joints.reserve(vertices);
  for (const Strongest& each : holds) {
    result.joints.push_back(normalised(each, where));
    float kept = 0.0F;
    for (const float weight : each.weights) kept += weight;
    if (each.others > 0.01F * (kept + each.others)) ++result.reducedVertices;
  }
  return result;
}

std::size_t highestJoint(const Mesh& mesh) {
  std::size_t highest = 0;
  for (const JointWeights& held : mesh.joints) {
    highest = std::max<std::size_t>(highest, *std::ranges::max_element(held.joints));
  }
  return highest;
}

}  // namespace pleinair::scene::gltf
