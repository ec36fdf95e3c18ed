#pragma once

#include <cmath>
#include <limits>
#include <optional>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "hal/cameras/synthetic/world/geometry.h"

namespace pleinair::hal::synthetic {

/// The first surface along a ray, found by testing every triangle of every facet (Möller and
/// Trumbore, 1997).
struct OracleHit {
  glm::dvec3 world{0};
  std::uint32_t facet = 0;
  Body body = kRoom;
};

inline std::optional<double> meetsTriangle(glm::dvec3 origin, glm::dvec3 direction, glm::dvec3 a,
                                           glm::dvec3 b, glm::dvec3 c) {
  const glm::dvec3 ab = b - a;
  const glm::dvec3 ac = c - a;
  const glm::dvec3 p = glm::cross(direction, ac);
  const double determinant = glm::dot(ab, p);
  if (determinant <= 0) return std::nullopt;  // from behind
  const glm::dvec3 s = origin - a;
  const double u = glm::dot(s, p) / determinant;
  const glm::dvec3 q = glm::cross(s, ab);
  const double v = glm::dot(direction, q) / determinant;
  const double t = glm::dot(ac, q) / determinant;
  if (u < 0 || v < 0 || u + v > 1 || t <= 0) return std::nullopt;
  return t;
}

inline std::optional<OracleHit> oracleHit(const Geometry& geometry, const CameraView& view,
                                          const BodyPoses& bodies, glm::dvec2 pixel) {
  const glm::dmat4 worldFromCamera = glm::inverse(view.cameraFromWorld);
  const glm::dvec3 origin(worldFromCamera * glm::dvec4(0, 0, 0, 1));
  const glm::dvec3 direction(worldFromCamera *
                             glm::dvec4((pixel.x - view.intrinsics.cx) / view.intrinsics.fx,
                                        (pixel.y - view.intrinsics.cy) / view.intrinsics.fy, 1, 0));
  double nearest = std::numeric_limits<double>::infinity();
  std::optional<OracleHit> hit;
  for (const Solid& solid : geometry.solids) {
    if (!bodies.has(solid.body)) continue;
    const glm::dmat4& pose = bodies[solid.body];
    for (std::uint32_t i = solid.firstFacet; i < solid.firstFacet + solid.facets; ++i) {
      const auto corners = geometry.cornersOf(geometry.facets[i]);
      const auto world = [&](std::size_t k) {
        return glm::dvec3(pose * glm::dvec4(corners[k], 1));
      };
      for (std::size_t k = 2; k < corners.size(); ++k) {
        const auto t = meetsTriangle(origin, direction, world(0), world(k - 1), world(k));
        if (!t || *t >= nearest) continue;
        nearest = *t;
        hit = OracleHit{origin + *t * direction, i, solid.body};
      }
    }
  }
  return hit;
}

}  // namespace pleinair::hal::synthetic
