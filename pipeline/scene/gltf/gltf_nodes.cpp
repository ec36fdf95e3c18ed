#include "pipeline/scene/gltf/gltf_nodes.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>
#include <glm/gtc/quaternion.hpp>

#include "pipeline/scene/gltf/gltf_fault.h"
#include "pipeline/scene/gltf/gltf_limits.h"

namespace pleinair::scene::gltf {
namespace {

constexpr int kNoParent = -1;

/// Numbers from the file, or `defaults` if it has none.
template <std::size_t N>
std::array<double, N> numbersOf(const std::vector<double>& values, std::array<double, N> defaults,
                                const std::string& where) {
  if (values.empty()) return defaults;
  if (values.size() != N) refuse(where, fmt::format("has {} numbers, not {}", values.size(), N));
  std::array<double, N> numbers{};
  for (std::size_t i = 0; i < N; ++i) {
    if (!(std::abs(values[i]) <= kMaxCoordinate)) {
      refuse(where, fmt::format("found {}", values[i]),
             fmt::format("numbers of at most {}", kMaxCoordinate));
    }
    numbers[i] = values[i];
  }
  return numbers;
}

glm::dmat4 matrixOf(const tinygltf::Node& node, const std::string& where) {
  const auto values = numbersOf<16>(node.matrix, {}, where + ".matrix");
  glm::dmat4 matrix(1.0);
  for (int column = 0; column < 4; ++column) {
    for (int row = 0; row < 3; ++row) {  // the last row is 0 0 0 1
      matrix[column][row] = values[static_cast<std::size_t>(4 * column + row)];
    }
  }
  return matrix;
}

NodePlace placeOf(const tinygltf::Node& node, const std::string& where) {
  const auto at = numbersOf<3>(node.translation, {}, where + ".translation");
  const auto turn = numbersOf<4>(node.rotation, {0.0, 0.0, 0.0, 1.0}, where + ".rotation");
  const auto scale = numbersOf<3>(node.scale, {1.0, 1.0, 1.0}, where + ".scale");
  const glm::dquat quaternion(turn[3], turn[0], turn[1], turn[2]);
  if (!(glm::length(quaternion) > 1e-9)) refuse(where + ".rotation", "is no rotation");
  return {.translation = {at[0], at[1], at[2]},
          .rotation = glm::normalize(quaternion),
          .scale = {scale[0], scale[1], scale[2]}};
}

RigNode rigNodeOf(const tinygltf::Node& node, const std::string& where) {
  RigNode result;
  if (node.matrix.empty()) {
    result.rest = placeOf(node, where);
  } else {
    result.parentFromNode = matrixOf(node, where);
  }
  return result;
}

std::vector<int> parentsOf(const tinygltf::Model& gltf) {
  std::vector<int> parents(gltf.nodes.size(), kNoParent);
  for (std::size_t i = 0; i < gltf.nodes.size(); ++i) {
    for (const int child : gltf.nodes[i].children) {
      const std::string where = fmt::format("nodes[{}].children", i);
      if (child < 0 || static_cast<std::size_t>(child) >= parents.size()) {
        refuse(where, fmt::format("there is no nodes[{}]", child));
      }
      int& parent = parents[static_cast<std::size_t>(child)];
      if (parent != kNoParent) {
        refuse(where, fmt::format("nodes[{}] is a child of nodes[{}] already", child, parent));
      }
      parent = static_cast<int>(i);
    }
  }
  return parents;
}

/// All nodes, parents first. Nodes in a cycle have no root above them and are not reached.
std::vector<std::size_t> parentsFirst(const tinygltf::Model& gltf,
                                      const std::vector<int>& parents) {
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < parents.size(); ++i) {
    if (parents[i] == kNoParent) order.push_back(i);
  }
  for (std::size_t next = 0; next < order.size(); ++next) {
    for (const int child : gltf.nodes[order[next]].children) {
      order.push_back(static_cast<std::size_t>(child));
    }
  }
  if (order.size() < parents.size()) {
    std::vector<bool> isReached(parents.size(), false);
    for (const std::size_t node : order) isReached[node] = true;
    const auto lost = std::ranges::find(isReached, false) - isReached.begin();
    refuse(fmt::format("nodes[{}]", lost), "is below itself");
  }
  return order;
}

/// Marks the nodes of the default scene: of the first scene if none is named, all if there is none.
std::vector<bool> shownNodes(const tinygltf::Model& gltf, const std::vector<std::size_t>& order,
                             const std::vector<int>& parents) {
  std::vector<bool> isShown(gltf.nodes.size(), gltf.scenes.empty());
  if (gltf.scenes.empty()) return isShown;
  const int scene = gltf.defaultScene == -1 ? 0 : gltf.defaultScene;
  if (scene < 0 || static_cast<std::size_t>(scene) >= gltf.scenes.size()) {
    refuse("scene", fmt::format("there is no scenes[{}]", scene));
  }
  for (const int root : gltf.scenes[static_cast<std::size_t>(scene)].nodes) {
    if (root < 0 || static_cast<std::size_t>(root) >= gltf.nodes.size()) {
      refuse(fmt::format("scenes[{}].nodes", scene), fmt::format("there is no nodes[{}]", root));
    }
    isShown[static_cast<std::size_t>(root)] = true;
  }
  for (const std::size_t node : order) {
    if (parents[node] != kNoParent && isShown[static_cast<std::size_t>(parents[node])]) {
      isShown[node] = true;
    }
  }
  return isShown;
}

}  // namespace

NodeTree nodeTreeOf(const tinygltf::Model& gltf) {
  const std::vector<int> parents = parentsOf(gltf);
  const std::vector<std::size_t> order = parentsFirst(gltf, parents);
  const std::vector<bool> isShown = shownNodes(gltf, order, parents);
  NodeTree tree;
  tree.rootFromNode.resize(gltf.nodes.size(), glm::dmat4(1.0));
  tree.rigIndex.resize(gltf.nodes.size(), 0);
  for (const std::size_t node : order) {
    RigNode own = rigNodeOf(gltf.nodes[node], fmt::format("nodes[{}]", node));
    glm::dmat4 rootFromNode = own.parentFromNode ? *own.parentFromNode : parentFromNode(own.rest);
    if (parents[node] != kNoParent) {
      const auto parent = static_cast<std::size_t>(parents[node]);
      own.parent = tree.rigIndex[parent];
      rootFromNode = tree.rootFromNode[parent] * rootFromNode;
    }
    if (!isBounded(rootFromNode)) {
      refuse(fmt::format("nodes[{}]", node), "is out of range after its parents' transforms");
    }
    tree.rootFromNode[node] = rootFromNode;
    tree.rigIndex[node] = tree.rig.size();
    tree.rig.push_back(std::move(own));
    if (isShown[node]) tree.shown.push_back(node);
  }
  return tree;
}

}  // namespace pleinair::scene::gltf
