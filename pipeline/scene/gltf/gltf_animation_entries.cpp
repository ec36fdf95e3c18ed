#include "pipeline/scene/gltf/gltf_animation_entries.h"

#include <fmt/format.h>

#include "pipeline/scene/gltf/gltf_fault.h"
#include "pipeline/scene/gltf/gltf_json.h"

namespace pleinair::scene::gltf {
namespace {

using nlohmann::json;

AnimationChannelEntry channelOf(const json& channel, const std::string& where) {
  AnimationChannelEntry entry{.sampler = countAt(channel, "sampler", where)};
  const json* target = find(channel, "target");
  if (target == nullptr) return entry;
  if (!target->is_object()) refuse(where + ".target", "is not an object");
  entry.node = countAt(*target, "node", where + ".target");
  entry.path = stringAt(*target, "path", where + ".target");
  return entry;
}

}  // namespace

std::vector<AnimationEntry> readAnimationEntries(const json& root) {
  std::vector<AnimationEntry> animations;
  for (const json* each : listAt(root, "animations")) {
    const std::string where = fmt::format("animations[{}]", animations.size());
    AnimationEntry& animation = animations.emplace_back();
    animation.name = stringAt(*each, "name", where);
    for (const json* channel : listAt(*each, "channels", where)) {
      animation.channels.push_back(
          channelOf(*channel, fmt::format("{}.channels[{}]", where, animation.channels.size())));
    }
    for (const json* sampler : listAt(*each, "samplers", where)) {
      const std::string name = fmt::format("{}.samplers[{}]", where, animation.samplers.size());
      animation.samplers.push_back({.input = countAt(*sampler, "input", name),
                                    .output = countAt(*sampler, "output", name),
                                    .interpolation = stringAt(*sampler, "interpolation", name)});
    }
  }
  return animations;
}

}  // namespace pleinair::scene::gltf
