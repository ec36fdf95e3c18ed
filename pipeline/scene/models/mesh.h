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

/// A corner of triangles. At a hard edge of a surface, each side has its own vertices.
struct MeshVertex {
  glm::vec3 position{0.0F};  ///< metres, in the model's frame
  glm::vec3 normal{0.0F};    ///< unit length, outward
  glm::vec2 texture{0.0F};   ///< across and down the image, which is 1 wide and high
  glm::vec4 colour{1.0F};    ///< linear light and coverage; multiplies the material's
};

/// Joint weights of a vertex, for the skin of its part; the weights sum to 1.
struct JointWeights {
  std::array<std::uint16_t, 4> joints{};
  std::array<float, 4> weights{1.0F, 0.0F, 0.0F, 0.0F};
};

/// Offsets to each vertex's position and normal; they are multiplied by a weight.
struct MorphTarget {
  std::vector<glm::vec3> positions;  ///< metres, one per vertex
  std::vector<glm::vec3> normals;    ///< one per vertex, or none
};

/// A surface. Triangles are counter-clockwise as seen from outside.
struct Mesh {
  std::vector<MeshVertex> vertices;
  std::vector<std::array<std::uint32_t, 3>> triangles;
  std::vector<JointWeights> joints{};       ///< per vertex if a skin deforms it, else empty
  std::vector<MorphTarget> morphTargets{};  ///< applied before joints
  /// Per vertex a direction along the surface (glTF's TANGENT), in the model's frame; or none. Only
  /// StrokeDirection asks for it.
  std::vector<glm::vec3> tangents{};
};

struct BoundingSphere {
  glm::dvec3 centre{0.0};
  double radiusMetres = 0.0;
};

/// A sphere around the centre of the mesh's bounding box; radius 0 for an empty mesh.
BoundingSphere boundingSphere(const Mesh& mesh);

/// The same surface with no edge longer than `maxEdgeMetres` (> 0). Triangles that shared an edge
/// or a vertex still do: longest edges are halved, and an edge's length is the same from both
/// sides. Existing vertices keep their positions; new ones interpolate joint weights and morph
/// targets. Stops at about `maxTriangles` triangles.
Mesh withShortEdges(const Mesh& mesh, float maxEdgeMetres,
                    std::size_t maxTriangles = std::numeric_limits<std::size_t>::max());

/// Upper bound of the factor by which an affine transform stretches lengths; exact where its axes
/// stay perpendicular.
double largestScale(const glm::dmat4& transform);

/// A sphere around the contents of a sphere after a transform.
BoundingSphere transformed(const BoundingSphere& sphere, const glm::dmat4& transform);

/// The matrix that transforms normals, up to their length: the matrix of cofactors. Unlike the
/// inverse it always exists; its sign keeps normals outward where `linear` mirrors.
glm::dmat3 normalsAlong(const glm::dmat3& linear);

/// Range of a morph target's vertex offsets at weight 1, along each axis.
struct MorphBounds {
  glm::vec3 min{0.0F};
  glm::vec3 max{0.0F};
};

/// A sphere around the vertices that a joint holds.
struct JointBounds {
  std::uint16_t joint = 0;
  float radiusMetres = 0.0F;
  glm::vec3 centre{0.0F};
};

/// Bounds of a surface's vertices and of their possible positions, so that bounding a pose need not
/// visit each vertex.
struct SurfaceBounds {
  BoundingSphere sphere;            ///< of the mesh at rest
  std::vector<MorphBounds> morphs;  ///< per morph target
  std::vector<JointBounds> joints;  ///< per joint that holds any vertex; none without a skin
};

SurfaceBounds boundsOf(const Mesh& mesh);

}  // namespace pleinair::scene
