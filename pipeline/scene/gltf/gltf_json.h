#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

namespace pleinair::scene::gltf {

/// Null where `object` is none, or has no such key.
const nlohmann::json* find(const nlohmann::json& object, const char* key);

/// Nothing where the key is absent. Throw Fault for values of another type.
std::optional<std::string> stringAt(const nlohmann::json& object, const char* key,
                                    const std::string& where);
std::optional<std::uint64_t> countAt(const nlohmann::json& object, const char* key,
                                     const std::string& where);

/// The objects of an array; none where it is absent. `where` is the object that holds it, empty for
/// the file's root. Throws Fault for what is no array of objects.
std::vector<const nlohmann::json*> listAt(const nlohmann::json& object, const char* key,
                                          const std::string& where = {});

}  // namespace pleinair::scene::gltf
