#pragma once

#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

namespace pleinair::scene {

/// Builds a glTF with its bytes in one buffer.
class GltfBuilder {
 public:
  nlohmann::json root = {{"asset", {{"version", "2.0"}}}};

  /// Returns the new bufferView's index.
  int addView(const void* bytes, std::size_t count) {
    while (binary_.size() % 4 != 0) binary_.push_back(0);
    root["bufferViews"].push_back(
        {{"buffer", 0}, {"byteOffset", binary_.size()}, {"byteLength", count}});
    const auto* first = static_cast<const std::uint8_t*>(bytes);
    binary_.insert(binary_.end(), first, first + count);
    return static_cast<int>(root["bufferViews"].size()) - 1;
  }

  /// Returns the new accessor's index.
  template <class T>
  int addAccessor(const std::vector<T>& values, const std::string& type, int componentType,
                  std::size_t components, bool normalized = false) {
    const int view = addView(values.data(), values.size() * sizeof(T));
    nlohmann::json accessor = {{"bufferView", view},
                               {"componentType", componentType},
                               {"count", values.size() / components},
                               {"type", type}};
    if (normalized) accessor["normalized"] = true;
    root["accessors"].push_back(accessor);
    return static_cast<int>(root["accessors"].size()) - 1;
  }
  int addFloats(const std::vector<float>& values, const std::string& type, std::size_t components) {
    return addAccessor(values, type, 5126, components);
  }

  /// Adds a mesh of one primitive and a node that shows it. Returns the primitive, for adding to
  /// it.
  nlohmann::json& addMesh(const std::vector<float>& positions, const std::string& name = "part") {
    const int accessor = addFloats(positions, "VEC3", 3);
    root["meshes"].push_back({{"primitives", {{{"attributes", {{"POSITION", accessor}}}}}}});
    root["nodes"].push_back({{"name", name}, {"mesh", root["meshes"].size() - 1}});
    return root["meshes"].back()["primitives"][0];
  }

  /// A .glb.
  std::vector<std::uint8_t> bytes() const {
    nlohmann::json whole = root;
    if (!binary_.empty() && !whole.contains("buffers")) {
      whole["buffers"] = {{{"byteLength", binary_.size()}}};
    }
    std::string text = whole.dump();
    text.append((4 - text.size() % 4) % 4, ' ');
    std::vector<std::uint8_t> padded = binary_;
    padded.resize((padded.size() + 3) / 4 * 4);
    std::vector<std::uint8_t> file;
    append(file, 0x46546C67);
    append(file, 2);
    append(file,
           static_cast<std::uint32_t>(20 + text.size() + (padded.empty() ? 0 : 8 + padded.size())));
    append(file, static_cast<std::uint32_t>(text.size()));
    append(file, 0x4E4F534A);
    file.insert(file.end(), text.begin(), text.end());
    if (padded.empty()) return file;
    append(file, static_cast<std::uint32_t>(padded.size()));
    append(file, 0x004E4942);
    file.insert(file.end(), padded.begin(), padded.end());
    return file;
  }

 private:
  static void append(std::vector<std::uint8_t>& to, std::uint32_t word) {
    for (int i = 0; i < 4; ++i) to.push_back(static_cast<std::uint8_t>(word >> (8 * i)));
  }

  std::vector<std::uint8_t> binary_;
};

}  // namespace pleinair::scene
