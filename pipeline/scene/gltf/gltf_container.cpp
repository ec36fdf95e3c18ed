#include "pipeline/scene/gltf/gltf_container.h"

#include <algorithm>
#include <string>

#include <fmt/format.h>

#include "pipeline/scene/gltf/gltf_fault.h"
#include "pipeline/scene/gltf/gltf_limits.h"

namespace pleinair::scene::gltf {
namespace {

constexpr std::size_t kHeaderBytes = 12;
constexpr std::size_t kChunkHeaderBytes = 8;
constexpr std::uint32_t kMagic = 0x46546C67;        // "glTF"
constexpr std::uint32_t kJsonChunk = 0x4E4F534A;    // "JSON"
constexpr std::uint32_t kBinaryChunk = 0x004E4942;  // "BIN"
constexpr const char* kExportAgain = "export or copy it again";

std::uint32_t wordAt(std::span<const std::uint8_t> bytes, std::size_t offset) {
  std::uint32_t word = 0;
  for (std::size_t i = 4; i-- > 0;) word = word << 8 | bytes[offset + i];
  return word;
}

struct Chunk {
  std::uint32_t type = 0;
  std::span<const std::uint8_t> bytes;
};

/// Removes the next chunk from the front of `rest`.
Chunk takeChunk(std::span<const std::uint8_t>& rest) {
  if (rest.size() < kChunkHeaderBytes) refuse("", "is truncated in a chunk's header", kExportAgain);
  const std::size_t length = wordAt(rest, 0);
  if (length > rest.size() - kChunkHeaderBytes) {
    refuse("",
           fmt::format("a chunk declares {} bytes but has {}", length,
                       rest.size() - kChunkHeaderBytes),
           kExportAgain);
  }
  if (length % 4 != 0) refuse("", fmt::format("a chunk of {} bytes is no multiple of 4", length));
  const Chunk chunk{wordAt(rest, 4), rest.subspan(kChunkHeaderBytes, length)};
  rest = rest.subspan(kChunkHeaderBytes + length);
  return chunk;
}

Container openBinary(std::span<const std::uint8_t> file) {
  if (file.size() < kHeaderBytes) refuse("", "is truncated in its header", kExportAgain);
  if (const std::uint32_t version = wordAt(file, 4); version != 2) {
    refuseUnsupported("", fmt::format("is binary glTF of version {}", version), "give version 2");
  }
  const std::size_t length = wordAt(file, 8);
  if (length > file.size()) {
    refuse("", fmt::format("declares {} bytes but has {}", length, file.size()), kExportAgain);
  }
  if (length < kHeaderBytes + kChunkHeaderBytes) {
    refuse("", fmt::format("declares {} bytes, too few for a chunk", length), kExportAgain);
  }
  std::span<const std::uint8_t> rest = file.subspan(kHeaderBytes, length - kHeaderBytes);
  const Chunk first = takeChunk(rest);
  if (first.type != kJsonChunk) refuse("", "its first chunk is not JSON");
  Container container;
  container.json = {reinterpret_cast<const char*>(first.bytes.data()), first.bytes.size()};
  for (bool isSecond = true; !rest.empty(); isSecond = false) {
    const Chunk chunk = takeChunk(rest);
    if (chunk.type == kJsonChunk) refuse("", "has two JSON chunks");
    if (chunk.type != kBinaryChunk) continue;  // other chunks are skipped
    if (!isSecond) refuse("", "has a BIN chunk that is not its second");
    container.binary = chunk.bytes;
  }
  return container;
}

}  // namespace

Container openContainer(std::span<const std::uint8_t> file) {
  if (file.empty()) refuse("", "is empty", kExportAgain);
  Container container;
  if (file.size() >= 4 && wordAt(file, 0) == kMagic) {
    container = openBinary(file);
  } else {
    const auto isSpace = [](std::uint8_t c) { return c == ' ' || (c >= '\t' && c <= '\r'); };
    const auto first = std::ranges::find_if_not(file, isSpace);
    if (first == file.end() || *first != '{') {
      refuse("", "is not glTF", "give a .glb or .gltf file of version 2");
    }
    container.json = {reinterpret_cast<const char*>(file.data()), file.size()};
  }
  if (container.json.size() > kMaxJsonBytes) {
    refuse("", fmt::format("has {} MiB of JSON", container.json.size() >> 20),
           fmt::format("at most {} MiB", kMaxJsonBytes >> 20));
  }
  return container;
}

}  // namespace pleinair::scene::gltf
