#include "pipeline/scene/gltf/gltf_structure.h"

#include <algorithm>
#include <array>
#include <string>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "config/config_error.h"
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

using nlohmann::json;

const json* find(const json& object, const char* key) {
  if (!object.is_object()) return nullptr;
  const auto found = object.find(key);
  return found == object.end() ? nullptr : &*found;
}

std::optional<std::string> stringAt(const json& object, const char* key, const std::string& where) {
  const json* value = find(object, key);
  if (value == nullptr) return std::nullopt;
  if (!value->is_string()) refuse(where + "." + key, "is not a string");
  return value->get<std::string>();
}

std::optional<std::uint64_t> countAt(const json& object, const char* key,
                                     const std::string& where) {
  const json* value = find(object, key);
  if (value == nullptr) return std::nullopt;
  if (!value->is_number_unsigned()) refuse(where + "." + key, "is not a whole number from 0 up");
  return value->get<std::uint64_t>();
}

std::vector<const json*> listAt(const json& object, const char* key, const std::string& where) {
  const json* list = find(object, key);
  std::vector<const json*> objects;
  if (list == nullptr) return objects;
  const std::string name = where.empty() ? key : where + "." + key;
  if (!list->is_array()) refuse(name, "is not an array");
  for (const json& each : *list) {
    if (!each.is_object()) refuse(fmt::format("{}[{}]", name, objects.size()), "is not an object");
    objects.push_back(&each);
  }
  return objects;
}

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

namespace {

using nlohmann::json;

constexpr std::array<std::string_view, 2> kExtensions{"KHR_mesh_quantization",
                                                      "KHR_texture_transform"};
constexpr std::array<const char*, 7> kAccessorTypes{"SCALAR", "VEC2", "VEC3", "VEC4",
                                                    "MAT2",   "MAT3", "MAT4"};

/// The first line of a library's message, which may quote a whole long string.
std::string firstLine(const std::string& text) {
  return text.substr(0, std::min<std::size_t>(text.find('\n'), 200));
}

/// Parses JSON with limits on nesting and on the number of values: later readers recurse, and a
/// value takes far more memory than its text.
json parseBounded(std::string_view text) {
  std::size_t values = 0;
  const auto bounded = [&](int depth, json::parse_event_t event, const json&) {
    if (depth > kMaxJsonDepth) {
      refuse("", fmt::format("its JSON is nested more than {} levels deep", kMaxJsonDepth));
    }
    const bool isValue = event == json::parse_event_t::value ||
                         event == json::parse_event_t::object_start ||
                         event == json::parse_event_t::array_start;
    if (isValue && ++values > kMaxJsonValues) {
      refuse("", fmt::format("its JSON has more than {} values", kMaxJsonValues));
    }
    return true;
  };
  try {
    return json::parse(text.begin(), text.end(), bounded);
  } catch (const json::exception& error) {
    refuse("", fmt::format("its JSON is broken: {}", firstLine(error.what())));
  }
}

void checkVersion(const json& root) {
  const json* asset = find(root, "asset");
  if (asset == nullptr) refuse("asset", "missing: it says glTF's version");
  for (const char* key : {"version", "minVersion"}) {
    const auto version = stringAt(*asset, key, "asset");
    if (!version && std::string_view(key) == "version") refuse("asset.version", "missing");
    if (!version) continue;
    const bool isKnown =
        key == std::string_view("version") ? version->starts_with("2.") : *version == "2.0";
    if (!isKnown) {
      refuseUnsupported(fmt::format("asset.{}", key), "found " + config::quoted(*version),
                        "version 2.0");
    }
  }
}

void checkExtensions(const json& root) {
  const json* required = find(root, "extensionsRequired");
  if (required == nullptr) return;
  if (!required->is_array()) refuse("extensionsRequired", "is not an array");
  std::vector<std::string> unknown;
  for (const json& each : *required) {
    if (!each.is_string()) refuse("extensionsRequired", "holds something that is not a string");
    const auto name = each.get<std::string>();
    if (std::ranges::find(kExtensions, name) == kExtensions.end()) {
      unknown.push_back(config::quoted(name));
    }
  }
  if (unknown.empty()) return;
  if (unknown.size() > 8) unknown.resize(8);
  refuseUnsupported("extensionsRequired",
                    fmt::format("needs {}, which is not supported", fmt::join(unknown, ", ")),
                    fmt::format("export without; supported are {}", fmt::join(kExtensions, ", ")));
}

std::vector<BufferEntry> readBuffers(const json& root) {
  std::vector<BufferEntry> buffers;
  for (const json* each : listAt(root, "buffers")) {
    const std::string where = fmt::format("buffers[{}]", buffers.size());
    const auto length = countAt(*each, "byteLength", where);
    if (!length) refuse(where + ".byteLength", "missing");
    if (*length < 1) refuse(where + ".byteLength", "found 0");
    buffers.push_back({stringAt(*each, "uri", where), *length});
  }
  return buffers;
}

std::vector<ImageEntry> readImages(const json& root) {
  std::vector<ImageEntry> images;
  for (const json* each : listAt(root, "images")) {
    const std::string where = fmt::format("images[{}]", images.size());
    images.push_back({stringAt(*each, "uri", where), countAt(*each, "bufferView", where)});
  }
  if (images.size() > kMaxImages) {
    refuse("images", fmt::format("there are {}", images.size()),
           fmt::format("at most {}", kMaxImages));
  }
  return images;
}

/// tinygltf refuses a file with an accessor of unknown type, even an unused one. Replaces such
/// accessors by valid ones and returns their types.
std::map<std::size_t, std::string> replaceUnknownTypes(json& root) {
  std::map<std::size_t, std::string> unknown;
  const auto list = root.find("accessors");
  if (list == root.end() || !list->is_array()) return unknown;
  for (std::size_t i = 0; i < list->size(); ++i) {
    const json* type = find((*list)[i], "type");
    if (type == nullptr || !type->is_string()) continue;
    const auto name = type->get<std::string>();
    if (std::ranges::find(kAccessorTypes, name) != kAccessorTypes.end()) continue;
    unknown[i] = name;
    (*list)[i] = {{"componentType", 5126}, {"count", 1}, {"type", "SCALAR"}};
  }
  return unknown;
}

void removeExtras(json& root) {
  for (const char* key : {"buffers", "images", "animations", "cameras", "extensions", "extras"}) {
    root.erase(key);
  }
}

}  // namespace

Structure readStructure(std::string_view text) {
  json root = parseBounded(text);
  if (!root.is_object()) refuse("", "its JSON is not an object");
  checkVersion(root);
  checkExtensions(root);
  if (const std::size_t nodes = listAt(root, "nodes").size(); nodes > kMaxNodes) {
    refuse("nodes", fmt::format("there are {}", nodes), fmt::format("at most {}", kMaxNodes));
  }
  Structure structure;
  structure.buffers = readBuffers(root);
  structure.images = readImages(root);
  structure.animations = readAnimationEntries(root);
  structure.unknownTypes = replaceUnknownTypes(root);
  removeExtras(root);

  const std::string rest = root.dump(-1, ' ', false, json::error_handler_t::replace);
  root = nullptr;
  tinygltf::TinyGLTF parser;
  std::string error;
  std::string warning;
  try {
    if (!parser.LoadASCIIFromString(&structure.gltf, &error, &warning, rest.data(),
                                    static_cast<unsigned>(rest.size()), "")) {
      refuse("", firstLine(error.empty() ? "cannot be parsed" : error));
    }
  } catch (const json::exception& fault) {  // a value has another type than it expects
    refuse("", fmt::format("its JSON is not glTF's: {}", firstLine(fault.what())));
  }
  return structure;
}

}  // namespace pleinair::scene::gltf
