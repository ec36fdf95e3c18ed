#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "pipeline/scene/gltf/gltf_accessors.h"
#include "pipeline/scene/gltf/gltf_structure.h"
#include "pipeline/scene/models/mesh.h"

namespace pleinair::scene::gltf {

/// Number of morph targets of a node's mesh (section 3.7.2.2); 0 without a mesh. Throws Fault above
/// kMaxMorphTargets.
std::size_t morphTargetsOf(const tinygltf::Model& gltf, std::size_t node);

/// Throws Fault where the primitives of a mesh (called `name`) have different numbers of targets.
void checkMorphTargets(const tinygltf::Mesh& mesh, const std::string& name);

/// Weights of the targets at rest: the node's, or else the mesh's, or else zeros. Throws Fault.
std::vector<float> restWeightsOf(const tinygltf::Model& gltf, std::size_t node);

/// Reads morph targets of primitives, within a limit on their total size.
class MorphReader {
 public:
  explicit MorphReader(Accessors& accessors) : accessors_(accessors) {}

  /// Reads the targets of `vertices` vertices, of which `kept` will be made (flat shading makes
  /// more). Throws Fault.
  std::vector<MorphTarget> read(const tinygltf::Primitive& primitive, std::size_t vertices,
                                std::size_t kept, const std::string& where);
  /// Whether any target moves more than positions and normals.
  bool hasOthers() const { return hasOthers_; }

 private:
  Accessors& accessors_;
  std::size_t moves_ = 0;
  bool hasOthers_ = false;
};

/// Adds normals to targets without any: the normals of a flat-shaded mesh at weight 1 of the
/// target, minus its normals without it.
void addFlatNormals(Mesh& mesh);

}  // namespace pleinair::scene::gltf
