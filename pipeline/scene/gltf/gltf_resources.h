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

/// A whole file, at most `mostBytes` of it. Throws Fault with `where`.
std::vector<std::uint8_t> readWholeFile(const std::filesystem::path& path, std::int64_t mostBytes,
                                        const std::string& where);

/// The file that a relative URI names, within `folder` also when links are followed. Throws Fault
/// for schemes, absolute paths, "..", and whatever leads out of the folder.
std::filesystem::path fileOf(std::string_view uri, const std::filesystem::path& folder,
                             const std::string& where);

/// The bytes in a data: URI. Throws Fault.
std::vector<std::uint8_t> bytesOfDataUri(std::string_view uri, const std::string& where);

/// The bytes and pictures that a glTF refers to. Each is read when it is first asked for: what
/// nobody uses is never opened. All throw Fault.
class Resources {
 public:
  /// `folder` is the only one that files are opened in; without, none is. Refers to `structure` and
  /// `binary`, a .glb's BIN chunk.
  Resources(const Structure& structure, std::optional<std::span<const std::uint8_t>> binary,
            std::optional<std::filesystem::path> folder);

  /// At least byteLength bytes; valid as long as this.
  std::span<const std::uint8_t> buffer(std::size_t index, const std::string& where);
  std::span<const std::uint8_t> bufferView(std::size_t index, const std::string& where);
  /// Decoded, as RGBA8. The same again for the same index.
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
