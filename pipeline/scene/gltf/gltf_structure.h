#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <nlohmann/json.hpp>
#include <nlohmann/json_fwd.hpp>

// Our own files, pictures and limits; all that is left to it is what the JSON says.
#define TINYGLTF_NO_FS
#define TINYGLTF_NO_STB_IMAGE
#define TINYGLTF_NO_STB_IMAGE_WRITE
#define TINYGLTF_NO_EXTERNAL_IMAGE
#include <tiny_gltf.h>

namespace pleinair::scene::gltf {

/// Null where `object` is none, or has no such key.
const nlohmann::json* find(const nlohmann::json& object, const char* key);

/// Nothing where the key is absent. Throw Fault for values of another type.
std::optional<std::string> stringAt(const nlohmann::json& object, const char* key,
                                    const std::string& where);
std::optional<std::uint64_t> countAt(const nlohmann::json& object, const char* key,
                                     const std::string& where);

/// The objects of an array; none where it is absent. `where` is the object that holds it, empty for
/// the file's root. Throws Fault for what is no array of objects.
std::vector<const nlohmann::json*> listAt(const nlohmann::json& object, const char* key,
                                          const std::string& where = {});

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

/// A buffer as the JSON has it; its bytes come when they are asked for.
struct BufferEntry {
  std::optional<std::string> uri;
  std::uint64_t byteLength = 0;
};

/// Likewise a picture.
struct ImageEntry {
  std::optional<std::string> uri;
  std::optional<std::size_t> bufferView;
};

/// What the JSON of a glTF says. Nothing in it has been looked up: every index and number may be
/// anything.
struct Structure {
  tinygltf::Model gltf;  ///< without buffers, images, cameras and animations
  std::vector<BufferEntry> buffers;
  std::vector<ImageEntry> images;
  std::vector<AnimationEntry> animations;
  std::map<std::size_t, std::string> unknownTypes;  ///< of accessors, by their index
};

/// Parses JSON within the limits and checks version and required extensions. Throws Fault.
Structure readStructure(std::string_view json);

}  // namespace pleinair::scene::gltf
