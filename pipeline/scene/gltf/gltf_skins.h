#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <vector>

#include "pipeline/scene/gltf/gltf_accessors.h"
#include "pipeline/scene/gltf/gltf_nodes.h"
#include "pipeline/scene/gltf/gltf_structure.h"
#include "pipeline/scene/models/mesh.h"
#include "pipeline/scene/models/rig.h"

namespace pleinair::scene::gltf {

/// Reads the skins that are used (section 3.7.3).
class SkinReader {
 public:
  SkinReader(const Structure& structure, Accessors& accessors, const NodeTree& tree)
      : structure_(structure), accessors_(accessors), tree_(tree) {}

  /// Index in `skins` of the file's skin; reads it on first use. Throws Fault.
  std::size_t place(int skin, std::vector<Skin>& skins, const std::string& where);

 private:
  Skin read(const tinygltf::Skin& skin, const std::string& name);

  const Structure& structure_;
  Accessors& accessors_;
  const NodeTree& tree_;
  std::map<int, std::size_t> places_;
};

/// Joint weights of a primitive's vertices: the four strongest joints of each.
struct VertexJoints {
  std::vector<JointWeights> joints;
  /// Vertices for which the dropped joints weigh more than a hundredth.
  std::size_t reducedVertices = 0;
};

/// Reads them. Without JOINTS_0, the first joint holds all vertices. Throws Fault.
VertexJoints readJointWeights(Accessors& accessors, const tinygltf::Primitive& primitive,
                              std::size_t vertices, const std::string& where);

/// The highest joint that holds any vertex; 0 if there is none.
std::size_t highestJoint(const Mesh& mesh);

}  // namespace pleinair::scene::gltf
