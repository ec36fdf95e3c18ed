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
#include "pipeline/scene/models/surface_bounds.h"

namespace pleinair::scene {

/// What a texture shows beyond its picture's edges.
enum class TextureEdge { kRepeat, kMirror, kClamp };

/// A picture on a surface: RGBA8, sRGB-coded.
struct ModelTexture {
  std::shared_ptr<const hal::Image> picture;
  TextureEdge across = TextureEdge::kRepeat;
  TextureEdge down = TextureEdge::kRepeat;
};

/// What a surface is of.
struct Material {
  std::string name;
  glm::vec4 baseColour{1.0F};          ///< linear light; the texture and vertices multiply it
  std::optional<std::size_t> texture;  ///< of Model::textures
  float coverageCutoff = 0.0F;         ///< where coverage (alpha) is less, nothing is; 0: solid
  bool isDoubleSided = false;          ///< else seen from outside only
};

/// Triangles of one material.
struct Surface {
  Mesh mesh;
  std::size_t material = 0;  ///< of Model::materials
};

/// A piece with a name of its own: a node of a glTF, a gear of a gearbox. It is rigid, or bent by a
/// skin and morph targets. Parts may share surfaces.
struct ModelPart {
  std::string name;
  std::size_t firstSurface = 0;  ///< of Model::surfaces
  std::size_t surfaceCount = 0;
  glm::dmat4 modelFromPart{1.0};  ///< where it is at rest; any affine transform
  std::optional<std::size_t>
      node;  ///< of Model::rig, that it goes with; its joints, if it has a skin
  std::optional<std::size_t> skin;  ///< of Model::rig
  /// Of ModelPose::matrices: one, or one for each joint of the skin.
  std::size_t firstMatrix = 0;
  std::size_t matrixCount = 1;
  std::size_t firstWeight = 0;  ///< of ModelPose::weights
  std::size_t weightCount = 0;  ///< as many as its surfaces have morph targets at most
  /// It turns about its own z axis, against the clock as seen from where that points.
  double radiansPerSecond = 0.0;
  /// Of the triangles of ArFrame::ids: parts count theirs one after another.
  std::uint32_t firstTriangle = 0;
  std::uint32_t triangleCount = 0;
};

/// What can be put into a scene. A value; immutable once made, so any thread may read it.
struct Model {
  std::vector<Surface> surfaces;
  std::vector<Material> materials;
  std::vector<ModelTexture> textures;
  std::vector<ModelPart> parts;
  std::vector<SurfaceBounds> bounds;  ///< of each surface; by numberParts()
  Rig rig;                            ///< empty where nothing but what turns by itself moves
  std::vector<std::string> notices;   ///< what of its file is not shown, a line each

  /// As drawn: a surface counts in each part that shows it.
  std::uint32_t triangleCount() const;
  /// As kept in memory: each surface once.
  std::size_t surfaceTriangles() const;
};

/// As Model::triangleCount(), of more than fit its numbers, too.
std::uint64_t drawnTriangles(const Model& model);

/// Counts each part's triangles, matrices and weights, and bounds each surface; sound where
/// drawnTriangles() fits in 32 bits. To be called once all is in its place.
void numberParts(Model& model);

/// A model of a single part and material, white.
Model singlePartModel(std::string name, Mesh mesh);

/// What turns a part in its own frame to where it is after `time`.
glm::dmat4 turnedAfter(const ModelPart& part, hal::Duration time);
/// Where a part that no rig moves is after `time` of turning.
glm::dmat4 modelFromPart(const ModelPart& part, hal::Duration time);

/// Around all parts at rest, wherever they turn to.
BoundingSphere boundingSphere(const Model& model);

/// The part that a triangle of ArFrame::ids belongs to; null where the model has no such triangle.
const ModelPart* partOfTriangle(const Model& model, std::uint32_t triangle);
/// Null where no part has that name; the first where several have.
const ModelPart* findPart(const Model& model, std::string_view name);

/// The same model with no edge longer than `maxEdgeMetres` (see the mesh's), measured in the
/// model's frame where parts are at rest.
Model withShortEdges(const Model& model, double maxEdgeMetres, std::size_t mostTriangles);

}  // namespace pleinair::scene
