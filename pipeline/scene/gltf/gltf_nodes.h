#pragma once

#include <string>
#include <vector>

#include <glm/mat4x4.hpp>

#include "pipeline/scene/gltf/gltf_structure.h"
#include "pipeline/scene/models/rig.h"

namespace pleinair::scene::gltf {

/// The tree of a glTF's nodes.
struct NodeTree {
  std::vector<glm::dmat4> rootFromNode;  ///< at rest; for each node of the file
  std::vector<RigNode> rig;              ///< all of them, parents first; without weights
  std::vector<std::size_t> rigIndex;     ///< of `rig`, for each node of the file
  std::vector<std::size_t> shown;        ///< nodes of the default scene, parents first
};

/// Throws Fault for children that are not there or have two parents, circles, and transforms that
/// are none.
NodeTree nodeTreeOf(const tinygltf::Model& gltf);

}  // namespace pleinair::scene::gltf
