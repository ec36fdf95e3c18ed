#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <nlohmann/json.hpp>
#include <nlohmann/json_fwd.hpp>

// We read files and images and apply limits ourselves; tinygltf only reads the JSON.
#define TINYGLTF_NO_FS
#define TINYGLTF_NO_STB_IMAGE
#define TINYGLTF_NO_STB_IMAGE_WRITE
#define TINYGLTF_NO_EXTERNAL_IMAGE
#include <tiny_gltf.h>

namespace pleinair::scene::gltf {

/// The two halves of a glTF file. Refers to the file's bytes.
struct Container {
  std::string_view json;
  std::optional<std::span<const std::uint8_t>> binary;  ///< BIN chunk of a .glb
};

/// Tells .glb (specification, section 4) from .gltf by the first bytes, and splits it. Throws
/// Fault.
Container openContainer(std::span<const std::uint8_t> file);

/// Returns null if `object` is not an object or has no such key.
const nlohmann::json* find(const nlohmann::json& object, const char* key);

/// Return nothing where the key is absent. Throw Fault for values of another type.
std::optional<std::string> stringAt(const nlohmann::json& object, const char* key,
                                    const std::string& where);
std::optional<std::uint64_t> countAt(const nlohmann::json& object, const char* key,
                                     const std::string& where);

/// The objects of an array; none if it is absent. `where` is the object that holds the array, empty
/// for the file's root. Throws Fault if the value is not an array of objects.
std::vector<const nlohmann::json*> listAt(const nlohmann::json& object, const char* key,
                                          const std::string& where = {});

/// Keys and values of an animation as indices of accessors; several channels may share them.
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

/// An animation as in the JSON; its indices are not checked yet.
struct AnimationEntry {
  std::optional<std::string> name;
  std::vector<AnimationChannelEntry> channels;
  std::vector<AnimationSamplerEntry> samplers;
};

/// Reads the entries. Throws Fault for values of other types than glTF's.
std::vector<AnimationEntry> readAnimationEntries(const nlohmann::json& root);

/// A buffer as in the JSON; its bytes are read on first use.
struct BufferEntry {
  std::optional<std::string> uri;
  std::uint64_t byteLength = 0;
};

/// An image as in the JSON; it is read on first use.
struct ImageEntry {
  std::optional<std::string> uri;
  std::optional<std::size_t> bufferView;
};

/// The JSON of a glTF. Its indices and numbers are not checked yet: each may be anything.
struct Structure {
  tinygltf::Model gltf;  ///< without buffers, images, cameras and animations
  std::vector<BufferEntry> buffers;
  std::vector<ImageEntry> images;
  std::vector<AnimationEntry> animations;
  /// Types of accessors that tinygltf does not know, by index.
  std::map<std::size_t, std::string> unknownTypes;
};

/// Parses JSON within the limits and checks version and required extensions. Throws Fault.
Structure readStructure(std::string_view json);

}  // namespace pleinair::scene::gltf
