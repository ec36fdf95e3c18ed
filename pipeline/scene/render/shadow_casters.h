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

/// Texels of a shadow's map, a side.
inline constexpr int kShadowMapTexels = 128;

/// Where on its plane (an attach frame's z = 0) the shadow of some models may fall, and how it
/// gets there. Lengths are metres of the attach frame.
struct ShadowPlan {
  glm::dvec2 centre{0.0};
  double half = 0.0;      ///< of the square that the map covers
  double height = 0.0;    ///< what is higher casts no shadow
  glm::dvec2 shear{0.0};  ///< how far the shadow of what is one metre high falls from its foot

  double texel() const { return 2.0 * half / kShadowMapTexels; }
  /// To the map's clip space: x and y by where the shadow falls, z by height.
  glm::dmat4 mapFromAttach() const;
  friend bool operator==(const ShadowPlan&, const ShadowPlan&) = default;
};

/// Plans for models within `spheres` under a key light. Nothing where none is near its plane. Sizes
/// go in steps and places by whole texels; `before` is kept while it does, so that shadows do not
/// crawl.
std::optional<ShadowPlan> planShadow(std::span<const BoundingSphere> spheres,
                                     const glm::dvec3& towardKey,
                                     const std::optional<ShadowPlan>& before);

/// A model's triangles between fewer of its vertices, for what is drawn small: those of a part (and
/// of a joint) that lie in one cell of a grid count as one (Rossignac and Borrel, "Multi-resolution
/// 3D approximations for rendering complex scenes", 1993). `rest`: where DrawnModel::rest is with
/// the model at rest, in the model's frame. Three indices of DrawnModel::rest a triangle.
std::vector<std::uint32_t> coarseTriangles(const DrawnModel& drawn,
                                           const std::vector<glm::vec3>& rest, double cellMetres);

/// The models that cast shadows, in few triangles of their posed vertices, so that they move as the
/// models do. All calls on the thread of the GL context it was made in.
class ShadowCasters {
 public:
  /// Keeps references. Occluders are not among them: the camera's picture has their shadows.
  ShadowCasters(const Scene& scene, const PosedGeometry& geometry);

  bool casts(std::size_t object) const { return !slots_.empty() && count(object) > 0; }
  /// Draws an object with the program in use: attribute 0 is its position in the model's frame.
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
  std::vector<std::size_t> slotOf_;  // of each model of the scene
  gpu::Buffer indices_;
  gpu::VertexArrayHandle vertexArray_;
};

}  // namespace pleinair::scene
