#include "pipeline/scene/gltf/gltf_json.h"

#include <fmt/format.h>

#include "pipeline/scene/gltf/gltf_fault.h"

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

}  // namespace pleinair::scene::gltf
