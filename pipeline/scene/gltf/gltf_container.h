#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

namespace pleinair::scene::gltf {

/// A glTF file's two halves. Refers to the file's bytes.
struct Container {
  std::string_view json;
  std::optional<std::span<const std::uint8_t>> binary;  ///< a .glb's BIN chunk
};

/// Tells .glb (specification, section 4) from .gltf by the first bytes, and takes it apart. Throws
/// Fault.
Container openContainer(std::span<const std::uint8_t> file);

}  // namespace pleinair::scene::gltf
