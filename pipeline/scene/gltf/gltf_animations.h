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

/// Reads animations (glTF 2.0, section 3.11) as clips of the tree's rig. Channels that the
/// specification tells readers to ignore get a notice; all other errors throw Fault.
class ClipReader {
 public:
  ClipReader(const Structure& structure, Resources& resources, const NodeTree& tree)
      : structure_(structure), tree_(tree), accessors_(structure, resources, kMaxKeyNumbers) {}

  /// Reads all clips that move something; each has a unique name.
  std::vector<Clip> read();
  /// One line for each kind of animation that was not read; valid after read().
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
  std::vector<std::string> emptyClips_;  ///< clips that move nothing
};

}  // namespace pleinair::scene::gltf
