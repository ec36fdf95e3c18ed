#include "hal/cameras/synthetic/world/geometry.h"

#include <algorithm>
#include <limits>

#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>
#include <glm/vec4.hpp>

namespace pleinair::hal {

PinholeIntrinsics syntheticIntrinsics(FrameSize size) {
  const double focal = 0.9375 * std::max(size.width, size.height);
  return {.fx = focal, .fy = focal, .cx = size.width / 2.0, .cy = size.height / 2.0};
}

}  // namespace pleinair::hal

namespace pleinair::hal::synthetic {

glm::dvec3 CameraView::eye() const {
  return -(glm::transpose(glm::dmat3(cameraFromWorld)) * glm::dvec3(cameraFromWorld[3]));
}

std::optional<glm::dvec2> CameraView::project(glm::dvec3 world) const {
  constexpr double kNearestMetres = 1e-6;
  const glm::dvec3 p(cameraFromWorld * glm::dvec4(world, 1));
  if (p.z < kNearestMetres) return std::nullopt;
  return glm::dvec2(intrinsics.fx * p.x / p.z + intrinsics.cx,
                    intrinsics.fy * p.y / p.z + intrinsics.cy);
}

Ray CameraView::through(glm::dvec2 pixel) const {
  const glm::dmat3 worldFromCamera = glm::transpose(glm::dmat3(cameraFromWorld));
  const glm::dvec3 inCamera((pixel.x - intrinsics.cx) / intrinsics.fx,
                            (pixel.y - intrinsics.cy) / intrinsics.fy, 1);
  return {eye(), worldFromCamera * inCamera};
}

namespace {

Ray movedBy(const glm::dmat4& pose, const Ray& ray) {
  return {glm::dvec3(pose * glm::dvec4(ray.origin, 1)),
          glm::dvec3(pose * glm::dvec4(ray.direction, 0))};
}

bool mayMeet(const Ray& ray, glm::dvec3 centre, double radius) {
  const glm::dvec3 toCentre = centre - ray.origin;
  const glm::dvec3 across = glm::cross(toCentre, ray.direction);
  return glm::dot(across, across) <= radius * radius * glm::dot(ray.direction, ray.direction);
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

std::optional<SurfacePoint> Geometry::firstAlong(const Ray& ray, const BodyPoses& bodies) const {
  double nearest = std::numeric_limits<double>::infinity();
  std::optional<SurfacePoint> found;
  for (const Solid& solid : solids) {
    if (!bodies.has(solid.body)) continue;
    const bool moves = solid.body != kRoom;
    const glm::dmat4& pose = bodies[solid.body];
    const glm::dvec3 centre = moves ? glm::dvec3(pose * glm::dvec4(solid.centre, 1)) : solid.centre;
    if (!mayMeet(ray, centre, solid.radius)) continue;
    const Ray local = moves ? movedBy(glm::inverse(pose), ray) : ray;
    for (std::uint32_t i = solid.firstFacet; i < solid.firstFacet + solid.facets; ++i) {
      const Facet& facet = facets[i];
      const double towards = glm::dot(facet.normal, local.direction);
      if (towards >= 0) continue;
      const double t = (facet.offset - glm::dot(facet.normal, local.origin)) / towards;
      if (t <= 0 || t >= nearest) continue;
      const glm::dvec3 point = local.origin + t * local.direction;
      if (!contains(cornersOf(facet), facet.normal, point)) continue;
      nearest = t;
      found = SurfacePoint{point, solid.body, i};
    }
  }
  return found;
}

glm::dvec3 inWorld(const SurfacePoint& point, const glm::dmat4& worldFromBody) {
  return point.body != kRoom ? glm::dvec3(worldFromBody * glm::dvec4(point.point, 1)) : point.point;
}

}  // namespace pleinair::hal::synthetic
