#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

namespace pleinair::scene::gltf {

/// Keys and values of an animation, which channels may share. Indices of accessors.
struct AnimationSamplerEntry {
  std::optional<std::uint64_t> input;
  std::optional<std::uint64_t> output;
  std::optional<std::string> interpolation;
};

struct AnimationChannelEntry {
  std::optional<std::uint64_t> sampler;
  std::optional<std::uint64_t> node;
  std::optional<std::string> path;
};

/// An animation as the JSON has it; nothing has been looked up.
struct AnimationEntry {
  std::optional<std::string> name;
  std::vector<AnimationChannelEntry> channels;
  std::vector<AnimationSamplerEntry> samplers;
};

/// Throws Fault for values of other types than glTF's.
std::vector<AnimationEntry> readAnimationEntries(const nlohmann::json& root);

}  // namespace pleinair::scene::gltf
