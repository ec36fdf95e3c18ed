#include "pipeline/scene/gltf/gltf_materials.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <glm/common.hpp>
#include <glm/mat3x3.hpp>

#include "pipeline/scene/gltf/gltf_fault.h"
#include "pipeline/scene/gltf/gltf_limits.h"

namespace pleinair::scene::gltf {
namespace {

constexpr float kHalf = 0.5F;

TextureEdge edgeOf(int wrap) {
  if (wrap == TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE) return TextureEdge::kClamp;
  return wrap == TINYGLTF_TEXTURE_WRAP_MIRRORED_REPEAT ? TextureEdge::kMirror
                                                       : TextureEdge::kRepeat;
}

float finite(double value, const std::string& where) {
  if (!(std::abs(value) <= kMaxCoordinate)) refuse(where, fmt::format("found {}", value));
  return static_cast<float>(value);
}

glm::vec2 pairAt(const tinygltf::Value& object, const char* key, glm::vec2 otherwise,
                 const std::string& where) {
  if (!object.Has(key)) return otherwise;
  const tinygltf::Value& pair = object.Get(key);
  if (!pair.IsArray() || pair.ArrayLen() != 2 || !pair.Get(0).IsNumber() ||
      !pair.Get(1).IsNumber()) {
    refuse(where + "." + key, "is not two numbers");
  }
  return {finite(pair.Get(0).GetNumberAsDouble(), where),
          finite(pair.Get(1).GetNumberAsDouble(), where)};
}

/// KHR_texture_transform: scale, then rotation, then offset.
TextureMapping mappingOf(const tinygltf::TextureInfo& info, const std::string& where) {
  TextureMapping mapping{.set = info.texCoord};
  const auto found = info.extensions.find("KHR_texture_transform");
  if (found != info.extensions.end() && found->second.IsObject()) {
    const tinygltf::Value& transform = found->second;
    const glm::vec2 offset = pairAt(transform, "offset", {0.0F, 0.0F}, where);
    const glm::vec2 scale = pairAt(transform, "scale", {1.0F, 1.0F}, where);
    float turn = 0.0F;
    if (transform.Has("rotation") && transform.Get("rotation").IsNumber()) {
      turn = finite(transform.Get("rotation").GetNumberAsDouble(), where);
    }
    if (transform.Has("texCoord") && transform.Get("texCoord").IsInt()) {
      mapping.set = transform.Get("texCoord").GetNumberAsInt();
    }
    const float c = std::cos(turn);
    const float s = std::sin(turn);
    mapping.transform = glm::mat3(c * scale.x, -s * scale.x, 0.0F, s * scale.y, c * scale.y, 0.0F,
                                  offset.x, offset.y, 1.0F);
  }
  if (mapping.set < 0 || mapping.set > 7) {
    refuse(where + ".texCoord", fmt::format("found {}", mapping.set), "0 to 7");
  }
  return mapping;
}

}  // namespace

std::size_t MaterialReader::texturePlace(int texture, Model& model, const std::string& where) {
  if (const auto known = texturePlaces_.find(texture); known != texturePlaces_.end()) {
    return known->second;
  }
  const auto& textures = structure_.gltf.textures;
  if (texture < 0 || static_cast<std::size_t>(texture) >= textures.size()) {
    refuse(where, fmt::format("there is no textures[{}]", texture));
  }
  const tinygltf::Texture& entry = textures[static_cast<std::size_t>(texture)];
  const std::string name = fmt::format("textures[{}]", texture);
  if (entry.source < 0) refuseUnsupported(name, "has no picture of a kind that is read");
  ModelTexture made{.picture =
                        resources_.image(static_cast<std::size_t>(entry.source), name + ".source")};
  if (entry.sampler >= 0) {
    const auto& samplers = structure_.gltf.samplers;
    if (static_cast<std::size_t>(entry.sampler) >= samplers.size()) {
      refuse(name + ".sampler", fmt::format("there is no samplers[{}]", entry.sampler));
    }
    const tinygltf::Sampler& sampler = samplers[static_cast<std::size_t>(entry.sampler)];
    made.across = edgeOf(sampler.wrapS);
    made.down = edgeOf(sampler.wrapT);
  }
  const std::size_t place = placeAmong(model.textures, std::move(made), name);
  texturePlaces_[texture] = place;
  return place;
}

/// Each texture here is one of the GPU, even if it shares an image: equal ones are made once.
std::size_t MaterialReader::placeAmong(std::vector<ModelTexture>& textures, ModelTexture made,
                                       const std::string& where) {
  const auto same = std::ranges::find_if(textures, [&](const ModelTexture& each) {
    return each.picture == made.picture && each.across == made.across && each.down == made.down;
  });
  if (same != textures.end()) return static_cast<std::size_t>(same - textures.begin());
  texturePixels_ += made.picture->size().pixels();
  if (texturePixels_ > kMaxTexturePixels) {
    refuse(where, "exceeds the total number of texture pixels",
           fmt::format("at most {} Mpx in all", kMaxTexturePixels / 1'000'000));
  }
  textures.push_back(std::move(made));
  return textures.size() - 1;
}

std::size_t MaterialReader::place(int material, Model& model, const std::string& where) {
  if (const auto known = places_.find(material); known != places_.end()) return known->second;
  const auto& materials = structure_.gltf.materials;
  Material made{.name = "default"};
  TextureMapping mapping;
  if (material != -1) {
    if (material < 0 || static_cast<std::size_t>(material) >= materials.size()) {
      refuse(where, fmt::format("there is no materials[{}]", material));
    }
    const tinygltf::Material& entry = materials[static_cast<std::size_t>(material)];
    const std::string name = fmt::format("materials[{}]", material);
    const auto& surface = entry.pbrMetallicRoughness;
    made.name = entry.name.empty() ? name : entry.name;
    for (std::size_t i = 0; i < std::min<std::size_t>(4, surface.baseColorFactor.size()); ++i) {
      made.baseColour[static_cast<int>(i)] =
          glm::clamp(finite(surface.baseColorFactor[i], name + ".baseColorFactor"), 0.0F, 1.0F);
    }
    made.isDoubleSided = entry.doubleSided;
    if (entry.alphaMode == "MASK") {
      made.coverageCutoff = glm::clamp(finite(entry.alphaCutoff, name), 0.0F, 1.0F);
    } else if (entry.alphaMode == "BLEND") {
      made.coverageCutoff = kHalf;
      blended_.push_back(made.name);
    }
    if (surface.baseColorTexture.index != -1) {
      const std::string texture = name + ".pbrMetallicRoughness.baseColorTexture";
      mapping = mappingOf(surface.baseColorTexture, texture);
      made.texture = texturePlace(surface.baseColorTexture.index, model, texture + ".index");
    }
  }
  model.materials.push_back(std::move(made));
  mappings_.push_back(mapping);
  places_[material] = model.materials.size() - 1;
  return model.materials.size() - 1;
}

}  // namespace pleinair::scene::gltf
