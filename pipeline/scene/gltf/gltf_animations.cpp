#include "pipeline/scene/gltf/gltf_animations.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "config/config_error.h"
#include "pipeline/scene/gltf/gltf_fault.h"
#include "pipeline/scene/gltf/gltf_limits.h"
#include "pipeline/scene/gltf/gltf_morphs.h"

namespace pleinair::scene::gltf {
namespace {

constexpr std::array<std::pair<std::string_view, AnimatedProperty>, 4> kPaths{
    {{"translation", AnimatedProperty::kTranslation},
     {"rotation", AnimatedProperty::kRotation},
     {"scale", AnimatedProperty::kScale},
     {"weights", AnimatedProperty::kWeights}}};

Interpolation interpolationOf(const std::optional<std::string>& name, const std::string& where) {
  if (!name || *name == "LINEAR") return Interpolation::kLinear;
  if (*name == "STEP") return Interpolation::kStep;
  if (*name == "CUBICSPLINE") return Interpolation::kCubicSpline;
  refuse(where + ".interpolation", "found " + config::quoted(*name), "LINEAR, STEP, CUBICSPLINE");
}

int accessorOf(const std::optional<std::uint64_t>& index, const std::string& where) {
  if (!index) refuse(where, "missing");
  if (*index > static_cast<std::uint64_t>(std::numeric_limits<int>::max())) {
    refuse(where, fmt::format("there is no accessors[{}]", *index));
  }
  return static_cast<int>(*index);
}

void checkTimes(const std::vector<float>& seconds, const std::string& where) {
  if (seconds.front() < 0.0F) refuse(where, fmt::format("starts at {} s", seconds.front()));
  const auto fallen = std::ranges::adjacent_find(
      seconds, [](float before, float after) { return !(before < after); });
  if (fallen != seconds.end()) {
    refuse(where, fmt::format("has a key at {} s after one at {} s", *(fallen + 1), *fallen),
           "times that rise from key to key");
  }
}

/// Checks that all values are rotations. Tangents may be anything.
void checkRotations(const Channel& channel, const std::string& where) {
  const bool isSpline = channel.interpolation == Interpolation::kCubicSpline;
  for (std::size_t key = 0; key < channel.seconds.size(); ++key) {
    const float* value = channel.values.data() + 4 * (isSpline ? 3 * key + 1 : key);
    if (!(std::hypot(std::hypot(value[0], value[1]), std::hypot(value[2], value[3])) > 1e-6F)) {
      refuse(fmt::format("{}: key {}", where, key), "is no rotation");
    }
  }
}

/// Gives unnamed clips a name, and makes all names unique.
void makeNamesUnique(std::vector<std::pair<std::size_t, Clip>>& clips) {
  std::set<std::string> taken;
  std::map<std::string, std::size_t> copies;  // number of clips so far with a name from the file
  for (auto& [index, clip] : clips) {
    if (clip.name.empty()) clip.name = fmt::format("animation {}", index + 1);
    std::size_t& count = copies[clip.name];
    const std::string base = clip.name;
    while (!taken.insert(clip.name).second) clip.name = fmt::format("{} {}", base, ++count + 1);
  }
}

}  // namespace

std::vector<Clip> ClipReader::read() {
  std::vector<std::pair<std::size_t, Clip>> clips;
  for (std::size_t i = 0; i < structure_.animations.size(); ++i) clips.emplace_back(i, readClip(i));
  makeNamesUnique(clips);
  std::vector<Clip> moving;
  for (auto& [index, clip] : clips) {
    if (clip.channels.empty()) {
      emptyClips_.push_back(clip.name);
    } else {
      moving.push_back(std::move(clip));
    }
  }
  return moving;
}

Clip ClipReader::readClip(std::size_t index) {
  const AnimationEntry& animation = structure_.animations[index];
  const std::string name = fmt::format("animations[{}]", index);
  Clip clip{.name = oneLine(animation.name.value_or(""))};
  std::set<std::pair<std::size_t, AnimatedProperty>> moved;
  for (std::size_t i = 0; i < animation.channels.size(); ++i) {
    const std::string where = fmt::format("{}.channels[{}]", name, i);
    auto channel = readChannel(animation, animation.channels[i], name, where);
    if (!channel) continue;
    if (!moved.emplace(channel->node, channel->property).second) {
      refuse(where + ".target", "is moved by a channel above already");
    }
    clip.seconds = std::max(clip.seconds, static_cast<double>(channel->seconds.back()));
    clip.channels.push_back(*std::move(channel));
  }
  return clip;
}

std::optional<Channel> ClipReader::readChannel(const AnimationEntry& animation,
                                               const AnimationChannelEntry& entry,
                                               const std::string& name, const std::string& where) {
  if (!entry.path) refuse(where + ".target.path", "missing");
  const auto path = std::ranges::find(kPaths, *entry.path, &decltype(kPaths)::value_type::first);
  if (path == kPaths.end()) {  // path of an extension, such as KHR_animation_pointer
    unknownPaths_.insert(config::quoted(*entry.path));
    return std::nullopt;
  }
  if (!entry.node) {  // ignored as section 3.11 says
    ++channelsWithoutNode_;
    return std::nullopt;
  }
  if (*entry.node >= tree_.rigIndex.size()) {
    refuse(where + ".target.node", fmt::format("there is no nodes[{}]", *entry.node));
  }
  const auto node = static_cast<std::size_t>(*entry.node);
  if (!entry.sampler) refuse(where + ".sampler", "missing");
  if (*entry.sampler >= animation.samplers.size()) {
    refuse(where + ".sampler", fmt::format("there is no {}.samplers[{}]", name, *entry.sampler));
  }
  Channel channel{.node = tree_.rigIndex[node],
                  .property = path->second,
                  .width = widthOf(path->second, node, where + ".target")};
  readKeys(animation.samplers[static_cast<std::size_t>(*entry.sampler)],
           fmt::format("{}.samplers[{}]", name, *entry.sampler), channel);
  return channel;
}

std::size_t ClipReader::widthOf(AnimatedProperty property, std::size_t node,
                                const std::string& where) const {
  if (property == AnimatedProperty::kWeights) {
    const std::size_t targets = morphTargetsOf(structure_.gltf, node);
    if (targets == 0) {
      refuse(where, fmt::format("nodes[{}] shows nothing that has morph targets", node));
    }
    return targets;
  }
  if (tree_.rig[tree_.rigIndex[node]].parentFromNode) {  // section 3.5.3
    refuse(where, fmt::format("nodes[{}] has a matrix, so that its parts cannot be moved", node),
           "translation, rotation and scale in its place");
  }
  return property == AnimatedProperty::kRotation ? 4 : 3;
}

void ClipReader::readKeys(const AnimationSamplerEntry& sampler, const std::string& where,
                          Channel& channel) {
  channel.interpolation = interpolationOf(sampler.interpolation, where);
  const std::string input = where + ".input";
  const std::string output = where + ".output";
  channel.seconds = accessors_.numbers(accessorOf(sampler.input, input), 1, false, input);
  checkTimes(channel.seconds, input);
  const bool isWeights = channel.property == AnimatedProperty::kWeights;
  const bool mayBeFractions = isWeights || channel.property == AnimatedProperty::kRotation;
  channel.values = accessors_.numbers(accessorOf(sampler.output, output),
                                      isWeights ? 1 : channel.width, mayBeFractions, output);
  const std::size_t perKey =
      channel.interpolation == Interpolation::kCubicSpline ? 3 * channel.width : channel.width;
  if (channel.values.size() != perKey * channel.seconds.size()) {
    refuse(output, fmt::format("has {} numbers, for {} keys of {}", channel.values.size(),
                               channel.seconds.size(), perKey));
  }
  if (channel.property == AnimatedProperty::kRotation) checkRotations(channel, output);
}

std::vector<std::string> ClipReader::notices() const {
  std::vector<std::string> notices;
  if (!unknownPaths_.empty()) {
    notices.push_back("its animations have unsupported targets: " +
                      shortList({unknownPaths_.begin(), unknownPaths_.end()}));
  }
  if (channelsWithoutNode_ > 0) {
    notices.push_back(fmt::format("{} of its animations' channels name no node and are not played",
                                  channelsWithoutNode_));
  }
  if (!emptyClips_.empty()) {
    notices.push_back("its animations without effect are left out: " + shortList(emptyClips_));
  }
  return notices;
}

}  // namespace pleinair::scene::gltf
