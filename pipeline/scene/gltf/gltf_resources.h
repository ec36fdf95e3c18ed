#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "hal/image.h"
#include "pipeline/scene/gltf/gltf_structure.h"

namespace pleinair::scene::gltf {

/// Reads a whole file of at most `maxBytes`. Throws Fault with `where`.
std::vector<std::uint8_t> readWholeFile(const std::filesystem::path& path, std::int64_t maxBytes,
                                        const std::string& where);

/// Resolves a relative URI to a file, which must be within `folder` after links are followed.
/// Throws Fault for schemes, absolute paths, "..", and paths that leave the folder.
std::filesystem::path fileOf(std::string_view uri, const std::filesystem::path& folder,
                             const std::string& where);

/// Decodes the bytes of a data: URI. Throws Fault.
std::vector<std::uint8_t> bytesOfDataUri(std::string_view uri, const std::string& where);

/// The buffers and images that a glTF refers to. Each is read on first use; unused ones are never
/// opened. All functions throw Fault.
class Resources {
 public:
  /// Files are opened in `folder` only; without a folder, none is opened. Refers to `structure` and
  /// `binary`, a .glb's BIN chunk.
  Resources(const Structure& structure, std::optional<std::span<const std::uint8_t>> binary,
            std::optional<std::filesystem::path> folder);

  /// At least byteLength bytes; valid as long as this object.
  std::span<const std::uint8_t> buffer(std::size_t index, const std::string& where);
  std::span<const std::uint8_t> bufferView(std::size_t index, const std::string& where);
  /// Decodes an image to RGBA8. The same index gives the same object.
  std::shared_ptr<const hal::Image> image(std::size_t index, const std::string& where);

 private:
  std::vector<std::uint8_t> load(std::string_view uri, const std::string& where);
  std::shared_ptr<const hal::Image> decode(std::span<const std::uint8_t> bytes,
                                           const std::string& where);

  const Structure& structure_;
  std::optional<std::span<const std::uint8_t>> binary_;
  std::optional<std::filesystem::path> folder_;
  std::map<std::size_t, std::vector<std::uint8_t>> buffers_;
  std::map<std::size_t, std::shared_ptr<const hal::Image>> images_;
  std::int64_t bytesLeft_;
  std::int64_t pixelsLeft_;
};

}  // namespace pleinair::scene::gltf
