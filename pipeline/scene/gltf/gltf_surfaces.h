#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>

#include <glm/mat4x4.hpp>

#include "pipeline/scene/gltf/gltf_accessors.h"
#include "pipeline/scene/gltf/gltf_structure.h"
#include "pipeline/scene/mesh.h"

namespace pleinair::scene::gltf {

/// How a material's texture lies on a surface: which TEXCOORD_n, and KHR_texture_transform.
struct TextureMapping {
  int set = 0;
  glm::mat3 transform{1.0F};
};

/// Reads primitives as meshes, within limits on how much all of them are together.
class SurfaceReader {
 public:
  SurfaceReader(const Structure& structure, Accessors& accessors)
      : structure_(structure), accessors_(accessors) {}

  /// The triangles of a primitive; nothing for points and lines. With `joints`, posed by them: they
  /// take it to where the joints are. Throws Fault.
  std::optional<Mesh> read(const tinygltf::Primitive& primitive, const TextureMapping& mapping,
                           std::span<const glm::dmat4> joints, const std::string& where);

 private:
  void readVertices(const tinygltf::Primitive& primitive, const TextureMapping& mapping,
                    const std::string& where, Mesh& mesh);
  void readTriangles(const tinygltf::Primitive& primitive, const std::string& where, Mesh& mesh);
  void pose(const tinygltf::Primitive& primitive, std::span<const glm::dmat4> joints,
            const std::string& where, Mesh& mesh);

  const Structure& structure_;
  Accessors& accessors_;
  std::size_t vertices_ = 0;
  std::size_t triangles_ = 0;
};

}  // namespace pleinair::scene::gltf
