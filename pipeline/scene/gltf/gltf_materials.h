#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "pipeline/scene/gltf/gltf_resources.h"
#include "pipeline/scene/gltf/gltf_structure.h"
#include "pipeline/scene/gltf/gltf_surfaces.h"
#include "pipeline/scene/models/model.h"

namespace pleinair::scene::gltf {

/// Reads the materials that are used, with their images.
class MaterialReader {
 public:
  MaterialReader(const Structure& structure, Resources& resources)
      : structure_(structure), resources_(resources) {}

  /// Index in model.materials of the file's material; -1 is glTF's default one. Reads it on first
  /// use. Throws Fault.
  std::size_t place(int material, Model& model, const std::string& where);
  /// The texture mapping, by index in model.materials.
  const TextureMapping& mapping(std::size_t place) const { return mappings_[place]; }
  /// Materials with blending, which is drawn as holes.
  const std::vector<std::string>& blended() const { return blended_; }

 private:
  std::size_t texturePlace(int texture, Model& model, const std::string& where);
  std::size_t placeAmong(std::vector<ModelTexture>& textures, ModelTexture made,
                         const std::string& where);

  const Structure& structure_;
  Resources& resources_;
  std::map<int, std::size_t> places_;
  std::map<int, std::size_t> texturePlaces_;
  std::vector<TextureMapping> mappings_;
  std::vector<std::string> blended_;
  std::int64_t texturePixels_ = 0;
};

}  // namespace pleinair::scene::gltf
