#pragma once

#include <string>
#include <vector>

#include <glm/mat4x4.hpp>

#include "pipeline/scene/gltf/gltf_structure.h"

namespace pleinair::scene::gltf {

/// The tree of a glTF's nodes, at rest.
struct NodeTree {
  std::vector<glm::dmat4> rootFromNode;  ///< for each node of the file
  std::vector<std::size_t> shown;        ///< nodes of the default scene, parents first
};

/// Throws Fault for children that are not there or have two parents, circles, and transforms that
/// are none.
NodeTree nodeTreeOf(const tinygltf::Model& gltf);

/// Whether all of it is finite and within kMaxCoordinate.
bool isBounded(const glm::dmat4& matrix);

}  // namespace pleinair::scene::gltf
