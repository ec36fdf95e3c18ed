#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <glm/mat4x4.hpp>
#include <glm/vec4.hpp>

#include "hal/clock.h"
#include "hal/image.h"
#include "pipeline/scene/models/mesh.h"
#include "pipeline/scene/models/rig.h"

namespace pleinair::scene {

/// Continuation of a texture beyond its image's edges.
enum class TextureEdge { kRepeat, kMirror, kClamp };

/// An image on a surface: RGBA8, sRGB-coded.
struct ModelTexture {
  std::shared_ptr<const hal::Image> picture;
  TextureEdge across = TextureEdge::kRepeat;
  TextureEdge down = TextureEdge::kRepeat;
};

/// The material of a surface.
struct Material {
  std::string name;
  glm::vec4 baseColour{1.0F};          ///< linear light; multiplied by the texture and the vertices
  std::optional<std::size_t> texture;  ///< index in Model::textures
  float coverageCutoff = 0.0F;  ///< pixels with less coverage (alpha) are not drawn; 0: opaque
  bool isDoubleSided = false;   ///< false: visible from outside only
};

/// What gives strokes on a model their direction.
struct StrokeDirection {
  enum class Source {
    kCurvature,  ///< the surface's form (surface_form.h)
    kTangents,   ///< Mesh::tangents; curvature where a surface has none
    kAxis,       ///< `axis`, seen along the surface
    kPicture     ///< the edges of its shaded picture alone
  };
  Source source = Source::kCurvature;
  glm::vec3 axis{0.0F};  ///< unit length, in the frame of the model at rest; only for kAxis
  friend bool operator==(const StrokeDirection&, const StrokeDirection&) = default;
};

/// Triangles of one material.
struct Surface {
  Mesh mesh;
  std::size_t material = 0;  ///< index in Model::materials
};

/// A named part of a model: a node of a glTF, a gear of a gearbox. It is rigid, or deformed by a
/// skin and morph targets. Parts may share surfaces.
struct ModelPart {
  std::string name;
  std::size_t firstSurface = 0;  ///< index in Model::surfaces
  std::size_t surfaceCount = 0;
  glm::dmat4 modelFromPart{1.0};    ///< position at rest; any affine transform
  std::optional<std::size_t> node;  ///< index in Model::rig; the node that moves it
  std::optional<std::size_t> skin;  ///< of Model::rig
  /// Index in ModelPose::matrices: of one matrix, or of one per joint of the skin.
  std::size_t firstMatrix = 0;
  std::size_t matrixCount = 1;
  std::size_t firstWeight = 0;  ///< index in ModelPose::weights
  std::size_t weightCount = 0;  ///< the largest number of morph targets of its surfaces
  /// Speed of rotation about its own z axis, counter-clockwise as seen from +z.
  double radiansPerSecond = 0.0;
  /// Number of its first triangle in ArFrame::ids: parts number theirs one after another.
  std::uint32_t firstTriangle = 0;
  std::uint32_t triangleCount = 0;
};

/// A model that can be placed in a scene. A value; immutable once made, so any thread may read it.
struct Model {
  std::vector<Surface> surfaces;
  std::vector<Material> materials;
  std::vector<ModelTexture> textures;
  std::vector<ModelPart> parts;
  std::vector<SurfaceBounds> bounds;  ///< per surface; set by numberParts()
  Rig rig;                            ///< empty unless something moves that does not turn by itself
  StrokeDirection strokeDirection;
  std::vector<std::string> notices;  ///< one line for each thing in its file that is not shown

  /// Triangles drawn: a surface counts once for each part that shows it.
  std::uint32_t triangleCount() const;
  /// Triangles in memory: each surface counts once.
  std::size_t surfaceTriangles() const;
};

/// The same as Model::triangleCount(), for counts beyond 32 bits too.
std::uint64_t drawnTriangles(const Model& model);

/// Numbers each part's triangles, matrices and weights, and computes the bounds of each surface.
/// Call it once everything is in place. Valid if drawnTriangles() fits in 32 bits.
void numberParts(Model& model);

/// A model of a single part with a single white material.
Model singlePartModel(std::string name, Mesh mesh);

/// The rotation of a part in its own frame after `time`.
glm::dmat4 turnedAfter(const ModelPart& part, hal::Duration time);
/// Position of a part without a rig after `time` of turning.
glm::dmat4 modelFromPart(const ModelPart& part, hal::Duration time);

/// A sphere around all parts at rest and during their whole rotation.
BoundingSphere boundingSphere(const Model& model);

/// The part to which a triangle of ArFrame::ids belongs; null if the model has no such triangle.
const ModelPart* partOfTriangle(const Model& model, std::uint32_t triangle);
/// Returns the first part with that name, or null.
const ModelPart* findPart(const Model& model, std::string_view name);

/// For each surface the largest scale at which it is drawn at rest; 0 if no part shows it.
std::vector<double> scalesAtRest(const Model& model);

/// The same model with no edge longer than `maxEdgeMetres` (see the mesh's function), measured in
/// the model's frame at rest.
Model withShortEdges(const Model& model, double maxEdgeMetres, std::size_t maxTriangles);

}  // namespace pleinair::scene
