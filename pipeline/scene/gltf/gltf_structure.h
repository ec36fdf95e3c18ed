#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

// Our own files, pictures and limits; all that is left to it is what the JSON says.
#define TINYGLTF_NO_FS
#define TINYGLTF_NO_STB_IMAGE
#define TINYGLTF_NO_STB_IMAGE_WRITE
#define TINYGLTF_NO_EXTERNAL_IMAGE
#include <tiny_gltf.h>

#include "pipeline/scene/gltf/gltf_animation_entries.h"

namespace pleinair::scene::gltf {

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
