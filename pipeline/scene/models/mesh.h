#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

namespace pleinair::scene {

/// A corner of triangles. Where a surface has a hard edge, each side has vertices of its own.
struct MeshVertex {
  glm::vec3 position{0.0F};  ///< metres, in the model's frame
  glm::vec3 normal{0.0F};    ///< unit length, outward
  glm::vec2 texture{0.0F};   ///< across and down the picture, which is 1 wide and high
  glm::vec4 colour{1.0F};    ///< linear light and coverage; multiplies the material's
};

/// The joints that hold a vertex, of its part's skin, and how much each does: weights sum to 1.
struct JointWeights {
  std::array<std::uint16_t, 4> joints{};
  std::array<float, 4> weights{1.0F, 0.0F, 0.0F, 0.0F};
};

/// What is added to each vertex's position and normal, times a weight.
struct MorphTarget {
  std::vector<glm::vec3> positions;  ///< metres, one a vertex
  std::vector<glm::vec3> normals;    ///< one a vertex, or none
};

/// A surface. Seen from outside, the vertices of a triangle go against the clock.
struct Mesh {
  std::vector<MeshVertex> vertices;
  std::vector<std::array<std::uint32_t, 3>> triangles;
  std::vector<JointWeights> joints{};       ///< of each vertex where a skin bends it, else none
  std::vector<MorphTarget> morphTargets{};  ///< applied before joints
};

struct BoundingSphere {
  glm::dvec3 centre{0.0};
  double radiusMetres = 0.0;
};

/// A sphere about the middle of the mesh's box; radius 0 for an empty mesh.
BoundingSphere boundingSphere(const Mesh& mesh);

/// The same surface with no edge longer than `maxEdgeMetres` (> 0). Triangles that shared an edge
/// or a vertex still do: longest edges are halved, and an edge's length is the same from both
/// sides. The vertices that there were keep their places; what holds or morphs them does so half
/// way, too. Beyond about `mostTriangles` the rest is left as it is.
Mesh withShortEdges(const Mesh& mesh, float maxEdgeMetres,
                    std::size_t mostTriangles = std::numeric_limits<std::size_t>::max());

/// So much longer an affine transform makes anything at most: never too little, and exact where its
/// axes stay perpendicular.
double largestScale(const glm::dmat4& transform);

/// Around what the sphere holds, once it is transformed.
BoundingSphere transformed(const BoundingSphere& sphere, const glm::dmat4& transform);

/// What takes normals along, to within their length: the matrix of cofactors, which unlike the
/// inverse always exists, with the sign that keeps them outward where `linear` mirrors.
glm::dmat3 normalsAlong(const glm::dmat3& linear);

}  // namespace pleinair::scene
