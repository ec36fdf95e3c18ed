#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

#include "pipeline/scene/models/model.h"
#include "pipeline/scene/models/model_pose.h"

namespace pleinair::measure {

using Triangle = std::array<glm::dvec3, 3>;

/// All triangles of a posed model, in the order of ArFrame::ids, in another frame.
std::vector<Triangle> trianglesOf(const scene::Model& model, const scene::ModelPose& pose,
                                  const glm::dmat4& frameFromModel);

struct SurfaceSample {
  std::uint32_t triangle = 0;
  glm::dvec3 barycentrics{0.0};

  glm::dvec3 on(std::span<const Triangle> triangles) const {
    const Triangle& at = triangles[triangle];
    return barycentrics.x * at[0] + barycentrics.y * at[1] + barycentrics.z * at[2];
  }
};

/// The basic surface sampling to which the thesis compares (§5.3.1, eq. 20-21): a triangle with a
/// probability proportional to its area, and a uniform point on it with the barycentrics 1 - √u, √u
/// (1 - v), √u v (eq. 25 as printed does not add up to one). Deterministic for a seed.
std::vector<SurfaceSample> sampleByArea(std::span<const Triangle> triangles, std::size_t count,
                                        unsigned seed);

}  // namespace pleinair::measure
