#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "pipeline/scene/gltf/gltf_accessors.h"
#include "pipeline/scene/gltf/gltf_structure.h"
#include "pipeline/scene/models/mesh.h"

namespace pleinair::scene::gltf {

/// How many morph targets the mesh of a node has (section 3.7.2.2); 0 without a mesh. Throws Fault
/// above kMaxMorphTargets.
std::size_t morphTargetsOf(const tinygltf::Model& gltf, std::size_t node);

/// Throws Fault where the primitives of a mesh, which is called `name`, have different counts.
void checkMorphTargets(const tinygltf::Mesh& mesh, const std::string& name);

/// How much each is shown at rest: as the node, or else its mesh says, or else not at all. Throws
/// Fault.
std::vector<float> restWeightsOf(const tinygltf::Model& gltf, std::size_t node);

/// Reads morph targets of primitives, within a limit on how much all of them are together.
class MorphReader {
 public:
  explicit MorphReader(Accessors& accessors) : accessors_(accessors) {}

  /// For `vertices` vertices, of which `kept` will be made (flat shading makes more). Throws Fault.
  std::vector<MorphTarget> read(const tinygltf::Primitive& primitive, std::size_t vertices,
                                std::size_t kept, const std::string& where);
  /// Whether any target has more than positions and normals to be moved.
  bool hasOthers() const { return hasOthers_; }

 private:
  Accessors& accessors_;
  std::size_t moves_ = 0;
  bool hasOthers_ = false;
};

/// The normals that a flat-shaded mesh has at weight 1 of each target, less those it has without:
/// for those targets that have none.
void addFlatNormals(Mesh& mesh);

}  // namespace pleinair::scene::gltf
