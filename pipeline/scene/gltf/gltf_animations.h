#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "pipeline/scene/gltf/gltf_accessors.h"
#include "pipeline/scene/gltf/gltf_nodes.h"
#include "pipeline/scene/gltf/gltf_resources.h"
#include "pipeline/scene/gltf/gltf_structure.h"
#include "pipeline/scene/models/rig.h"

namespace pleinair::scene::gltf {

/// Reads animations (glTF 2.0, section 3.11) as clips of the tree's rig. What the specification
/// says to ignore gets a notice; all else that is wrong throws Fault.
class ClipReader {
 public:
  ClipReader(const Structure& structure, Resources& resources, const NodeTree& tree)
      : structure_(structure), tree_(tree), accessors_(structure, resources, kMaxKeyNumbers) {}

  /// Each has a name of its own, and something that it moves.
  std::vector<Clip> read();
  /// What of them is not played, once they are read; a line each.
  std::vector<std::string> notices() const;

 private:
  Clip readClip(std::size_t index);
  std::optional<Channel> readChannel(const AnimationEntry& animation,
                                     const AnimationChannelEntry& entry, const std::string& name,
                                     const std::string& where);
  std::size_t widthOf(AnimatedProperty property, std::size_t node, const std::string& where) const;
  void readKeys(const AnimationSamplerEntry& sampler, const std::string& where, Channel& channel);

  const Structure& structure_;
  const NodeTree& tree_;
  Accessors accessors_;
  std::set<std::string> unknownPaths_;
  std::size_t channelsWithoutNode_ = 0;
  std::vector<std::string> still_;  ///< clips that move nothing
};

}  // namespace pleinair::scene::gltf
