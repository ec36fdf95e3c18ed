#pragma once

#include <string>
#include <vector>

#include <glm/mat4x4.hpp>

#include "pipeline/scene/gltf/gltf_structure.h"
#include "pipeline/scene/models/rig.h"

namespace pleinair::scene::gltf {

/// The tree of a glTF's nodes.
struct NodeTree {
  std::vector<glm::dmat4> rootFromNode;  ///< at rest; per node of the file
  std::vector<RigNode> rig;              ///< all nodes, parents first; without weights
  std::vector<std::size_t> rigIndex;     ///< index in `rig`, per node of the file
  std::vector<std::size_t> shown;        ///< nodes of the default scene, parents first
};

/// Builds the tree. Throws Fault for missing children, children with two parents, cycles, and
/// invalid transforms.
NodeTree nodeTreeOf(const tinygltf::Model& gltf);

}  // namespace pleinair::scene::gltf
