#include "hal/cameras/synthetic/geometry.h"

#include <limits>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

namespace pleinair::hal::synthetic {
namespace {

Ray movedBy(const glm::dmat4& pose, const Ray& ray) {
  return {glm::dvec3(pose * glm::dvec4(ray.origin, 1)),
          glm::dvec3(pose * glm::dvec4(ray.direction, 0))};
}

bool mayMeet(const Ray& ray, const Solid& solid) {
  const glm::dvec3 toCentre = solid.centre - ray.origin;
  const glm::dvec3 across = glm::cross(toCentre, ray.direction);
  return glm::dot(across, across) <=
         solid.radius * solid.radius * glm::dot(ray.direction, ray.direction);
}

bool contains(std::span<const glm::dvec3> corners, glm::dvec3 normal, glm::dvec3 point) {
  glm::dvec3 from = corners.back();
  for (const glm::dvec3& to : corners) {
    if (glm::dot(glm::cross(to - from, point - from), normal) < 0) return false;
    from = to;
  }
  return true;
}

}  // namespace

std::optional<SurfacePoint> Geometry::firstAlong(const Ray& ray,
                                                 const glm::dmat4& worldFromMover) const {
  const Ray inMover = movedBy(glm::inverse(worldFromMover), ray);
  double nearest = std::numeric_limits<double>::infinity();
  std::optional<SurfacePoint> found;
  for (const Solid& solid : solids) {
    const Ray& local = solid.moves ? inMover : ray;
    if (!mayMeet(local, solid)) continue;
    for (std::uint32_t i = solid.firstFacet; i < solid.firstFacet + solid.facets; ++i) {
      const Facet& facet = facets[i];
      const double towards = glm::dot(facet.normal, local.direction);
      if (towards >= 0) continue;
      const double t = (facet.offset - glm::dot(facet.normal, local.origin)) / towards;
      if (t <= 0 || t >= nearest) continue;
      const glm::dvec3 point = local.origin + t * local.direction;
      if (!contains(cornersOf(facet), facet.normal, point)) continue;
      nearest = t;
      found = SurfacePoint{point, solid.moves, i};
    }
  }
  return found;
}

glm::dvec3 inWorld(const SurfacePoint& point, const glm::dmat4& worldFromMover) {
  return point.moves ? glm::dvec3(worldFromMover * glm::dvec4(point.point, 1)) : point.point;
}

}  // namespace pleinair::hal::synthetic
