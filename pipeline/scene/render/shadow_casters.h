#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "pipeline/gpu/buffer.h"
#include "pipeline/gpu/handle.h"
#include "pipeline/scene/description/scene.h"
#include "pipeline/scene/models/mesh.h"
#include "pipeline/scene/render/drawn_model.h"
#include "pipeline/scene/render/posed_geometry.h"

namespace pleinair::scene {

/// Side of a shadow map, in texels.
inline constexpr int kShadowMapTexels = 128;

/// The area of a plane (z = 0 of an attach frame) on which shadows of some models may fall, and
/// their projection. Lengths are metres of the attach frame.
struct ShadowPlan {
  glm::dvec2 centre{0.0};
  double half = 0.0;      ///< half the side of the square that the map covers
  double height = 0.0;    ///< higher parts cast no shadow
  glm::dvec2 shear{0.0};  ///< offset of the shadow of a point at height one metre

  double texel() const { return 2.0 * half / kShadowMapTexels; }
  /// Transform to the map's clip space: x and y of the shadow, z by height.
  glm::dmat4 mapFromAttach() const;
  friend bool operator==(const ShadowPlan&, const ShadowPlan&) = default;
};

/// Plans the shadow of models within `spheres` under a key light. Returns nothing if none is near
/// its plane. Sizes change in steps and positions in whole texels, and `before` is kept while it
/// fits, so that shadows do not crawl.
std::optional<ShadowPlan> planShadow(std::span<const BoundingSphere> spheres,
                                     const glm::dvec3& towardKey,
                                     const std::optional<ShadowPlan>& before);

/// A model's triangles over fewer vertices, for drawing it small: the vertices of a part (and of a
/// joint) that lie in one grid cell are merged (Rossignac and Borrel, "Multi-resolution 3D
/// approximations for rendering complex scenes", 1993). `rest`: positions of DrawnModel::rest with
/// the model at rest, in the model's frame. Returns three indices of DrawnModel::rest per triangle.
std::vector<std::uint32_t> coarseTriangles(const DrawnModel& drawn,
                                           const std::vector<glm::vec3>& rest, double cellMetres);

/// The models that cast shadows, as few triangles of their posed vertices, so that shadows move
/// with the models. All calls on the thread of the GL context that it was made in.
class ShadowCasters {
 public:
  /// Keeps references. Occluders are left out: the camera image has their shadows.
  ShadowCasters(const Scene& scene, const PosedGeometry& geometry);

  bool casts(std::size_t object) const { return !slots_.empty() && count(object) > 0; }
  /// Draws an object with the program in use; attribute 0 is its position in the model's frame.
  void draw(std::size_t object) const;

 private:
  struct Slot {
    const Model* model = nullptr;
    std::size_t firstIndex = 0;
    std::size_t indexCount = 0;
  };
  std::size_t count(std::size_t object) const { return slots_[slotOf_[object]].indexCount; }

  const PosedGeometry& geometry_;
  std::vector<Slot> slots_;
  std::vector<std::size_t> slotOf_;  // per model of the scene
  gpu::Buffer indices_;
  gpu::VertexArrayHandle vertexArray_;
};

}  // namespace pleinair::scene
