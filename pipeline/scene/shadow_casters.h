#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "pipeline/gpu/buffer.h"
#include "pipeline/gpu/handle.h"
#include "pipeline/scene/drawn_model.h"
#include "pipeline/scene/posed_geometry.h"
#include "pipeline/scene/scene.h"

namespace pleinair::scene {

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
