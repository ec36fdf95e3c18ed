#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include <glm/mat3x3.hpp>

#include "pipeline/scene/gltf/gltf_accessors.h"
#include "pipeline/scene/gltf/gltf_morphs.h"
#include "pipeline/scene/gltf/gltf_structure.h"
#include "pipeline/scene/models/mesh.h"

namespace pleinair::scene::gltf {

/// How a material's texture lies on a surface: which TEXCOORD_n, and KHR_texture_transform.
struct TextureMapping {
  int set = 0;
  glm::mat3 transform{1.0F};
};

/// Reads primitives as meshes, within limits on how much all of them are together.
class SurfaceReader {
 public:
  explicit SurfaceReader(Accessors& accessors) : accessors_(accessors), morphs_(accessors) {}

  /// The triangles of a primitive with its morph targets; nothing for points and lines. With
  /// `isSkinned`, also what joints hold its vertices. Throws Fault.
  std::optional<Mesh> read(const tinygltf::Primitive& primitive, const TextureMapping& mapping,
                           bool isSkinned, const std::string& where);

  /// Of what was read: vertices that more joints hold than are kept, and whether morph targets have
  /// more than is moved.
  std::size_t heldByMore() const { return heldByMore_; }
  bool hasOtherMorphs() const { return morphs_.hasOthers(); }

 private:
  void readVertices(const tinygltf::Primitive& primitive, const TextureMapping& mapping,
                    const std::string& where, Mesh& mesh);
  void readTriangles(const tinygltf::Primitive& primitive, const std::string& where, Mesh& mesh);

  Accessors& accessors_;
  MorphReader morphs_;
  std::size_t heldByMore_ = 0;
  std::size_t vertices_ = 0;
  std::size_t triangles_ = 0;
};

}  // namespace pleinair::scene::gltf
