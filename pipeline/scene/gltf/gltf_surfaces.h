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

/// Texture mapping of a material on a surface: TEXCOORD_n and KHR_texture_transform.
struct TextureMapping {
  int set = 0;
  glm::mat3 transform{1.0F};
};

/// Reads primitives as meshes, within limits on their total size.
class SurfaceReader {
 public:
  explicit SurfaceReader(Accessors& accessors) : accessors_(accessors), morphs_(accessors) {}

  /// Reads the triangles of a primitive with its morph targets; nothing for points and lines. With
  /// `isSkinned`, also reads the joint weights of its vertices. Throws Fault.
  std::optional<Mesh> read(const tinygltf::Primitive& primitive, const TextureMapping& mapping,
                           bool isSkinned, const std::string& where);

  /// Notices about everything read so far: the number of vertices with more joints than are kept,
  /// and whether morph targets move more than is supported.
  std::size_t reducedVertices() const { return reducedVertices_; }
  bool hasOtherMorphs() const { return morphs_.hasOthers(); }

 private:
  void readVertices(const tinygltf::Primitive& primitive, const TextureMapping& mapping,
                    const std::string& where, Mesh& mesh);
  void readTriangles(const tinygltf::Primitive& primitive, const std::string& where, Mesh& mesh);

  Accessors& accessors_;
  MorphReader morphs_;
  std::size_t reducedVertices_ = 0;
  std::size_t vertices_ = 0;
  std::size_t triangles_ = 0;
};

}  // namespace pleinair::scene::gltf
