#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

namespace pleinair::scene::gltf {

/// The two halves of a glTF file. Refers to the file's bytes.
struct Container {
  std::string_view json;
  std::optional<std::span<const std::uint8_t>> binary;  ///< BIN chunk of a .glb
};

/// Tells .glb (specification, section 4) from .gltf by the first bytes, and splits it. Throws
/// Fault.
Container openContainer(std::span<const std::uint8_t> file);

}  // namespace pleinair::scene::gltf
