#include "pipeline/scene/gltf/gltf_structure.h"

#include <algorithm>
#include <array>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "config/config_error.h"
#include "pipeline/scene/gltf/gltf_fault.h"
#include "pipeline/scene/gltf/gltf_limits.h"

namespace pleinair::scene::gltf {

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
