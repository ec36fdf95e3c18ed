#pragma once

#include <optional>
#include <span>

#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "pipeline/scene/mesh.h"

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

}  // namespace pleinair::scene
