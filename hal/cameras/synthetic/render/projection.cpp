#include "hal/cameras/synthetic/render/projection.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>

#include <glm/geometric.hpp>
#include <glm/vec2.hpp>

namespace pleinair::hal::synthetic {
namespace {

constexpr double kNearMetres = 0.03;
constexpr std::size_t kMaxCorners = 40;

struct Corners {
  std::array<glm::dvec3, kMaxCorners> points{};
  std::size_t count = 0;
  void add(glm::dvec3 point) {
    if (count < points.size()) points[count++] = point;
  }
};

/// Clips a convex outline, in camera coordinates, against the near plane.
Corners clippedNear(const Corners& all) {
  Corners kept;
  for (std::size_t i = 0; i < all.count; ++i) {
    const glm::dvec3 from = all.points[i];
    const glm::dvec3 to = all.points[(i + 1) % all.count];
    if (from.z >= kNearMetres) kept.add(from);
    if ((from.z >= kNearMetres) != (to.z >= kNearMetres)) {
      kept.add(from + (to - from) * ((kNearMetres - from.z) / (to.z - from.z)));
    }
  }
  return kept;
}

/// A linear function of a point in camera coordinates, divided by the point's depth.
ImageLinear dividedByDepth(glm::dvec3 linear, const PinholeIntrinsics& k) {
  const double x = linear.x / k.fx;
  const double y = linear.y / k.fy;
  return {x, y, linear.z - x * k.cx - y * k.cy};
}

ImageLinear plus(const ImageLinear& a, const ImageLinear& b, double times) {
  return {a.x + times * b.x, a.y + times * b.y, a.one + times * b.one};
}

}  // namespace

bool project(const Geometry& geometry, std::uint32_t facet, const glm::dmat4& cameraFromSolid,
             const PinholeIntrinsics& k, ProjectedFacet& out) {
  constexpr double kEdgeOnMetres = 1e-6;
  const Facet& flat = geometry.facets[facet];
  const glm::dmat3 turn(cameraFromSolid);
  const glm::dvec3 shift(cameraFromSolid[3]);
  const glm::dvec3 normal = turn * flat.normal;
  // distance of the plane from the eye
  const double offset = flat.offset + glm::dot(normal, shift);
  if (offset > -kEdgeOnMetres) return false;

  Corners corners;
  double nearest = std::numeric_limits<double>::infinity();
  double farthest = -nearest;
  for (const glm::dvec3& corner : geometry.cornersOf(flat)) {
    corners.add(turn * corner + shift);
    nearest = std::min(nearest, corners.points[corners.count - 1].z);
    farthest = std::max(farthest, corners.points[corners.count - 1].z);
  }
  if (farthest < kNearMetres) return false;
  if (nearest < kNearMetres) corners = clippedNear(corners);
  if (corners.count < 3) return false;

  double left = std::numeric_limits<double>::infinity();
  double right = -left;
  double top = left;
  double bottom = -left;
  std::array<glm::dvec2, kMaxCorners> outline{};
  for (std::size_t i = 0; i < corners.count; ++i) {
    const glm::dvec3& p = corners.points[i];
    outline[i] = {k.fx * p.x / p.z + k.cx, k.fy * p.y / p.z + k.cy};
    left = std::min(left, outline[i].x);
    right = std::max(right, outline[i].x);
    top = std::min(top, outline[i].y);
    bottom = std::max(bottom, outline[i].y);
  }

  out.facet = facet;
  out.left = static_cast<float>(left);
  out.right = static_cast<float>(right);
  out.top = static_cast<float>(top);
  out.bottom = static_cast<float>(bottom);
  out.edges.clear();
  for (std::size_t i = 0; i < corners.count; ++i) {
    glm::dvec2 from = outline[i];
    glm::dvec2 to = outline[(i + 1) % corners.count];
    if (from.y > to.y) std::swap(from, to);
    if (static_cast<float>(to.y) <= static_cast<float>(from.y)) continue;
    const double slope = (to.x - from.x) / (to.y - from.y);
    out.edges.push_back({static_cast<float>(from.x), static_cast<float>(from.y),
                         static_cast<float>(to.y), static_cast<float>(slope)});
  }
  out.inverseDepth = dividedByDepth(normal / offset, k);
  const auto canvas = [&](const glm::dvec4& row) {
    const glm::dvec3 direction = turn * glm::dvec3(row);
    return plus(dividedByDepth(direction, k), out.inverseDepth, row.w - glm::dot(direction, shift));
  };
  out.uOverDepth = canvas(flat.u);
  out.vOverDepth = canvas(flat.v);
  return true;
}

bool mayBeVisible(const Solid& solid, const glm::dmat4& cameraFromSolid, const PinholeIntrinsics& k,
                  FrameSize size, double marginPx) {
  const glm::dvec3 centre(cameraFromSolid * glm::dvec4(solid.centre, 1));
  if (centre.z + solid.radius < kNearMetres) return false;
  // Tests the sphere against the planes through the eye and the image's sides.
  const auto isBeyond = [&](double at, double focal, double first, double last) {
    const double low = (first - marginPx) / focal;
    const double high = (last + marginPx) / focal;
    return (at - low * centre.z) < -solid.radius * std::hypot(1, low) ||
           (high * centre.z - at) < -solid.radius * std::hypot(1, high);
  };
  return !isBeyond(centre.x, k.fx, -k.cx, size.width - k.cx) &&
         !isBeyond(centre.y, k.fy, -k.cy, size.height - k.cy);
}

}  // namespace pleinair::hal::synthetic
