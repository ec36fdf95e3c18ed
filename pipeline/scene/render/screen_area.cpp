#include "pipeline/scene/render/screen_area.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "pipeline/scene/description/lens.h"

namespace pleinair::scene {

ScreenArea areaAround(std::span<const glm::dvec3> cameraCorners,
                      const tracking::CameraModel& camera) {
  const glm::ivec2 picture(camera.imageSize().width, camera.imageSize().height);
  const double widest = trustedLensRadius(camera.distortion());
  glm::dvec2 low(HUGE_VAL);
  glm::dvec2 high(-HUGE_VAL);
  for (const glm::dvec3& corner : cameraCorners) {
    if (corner.z < 1e-3 || glm::length(glm::dvec2(corner)) > widest * corner.z) {
      return {{0, 0}, picture};
    }
    const glm::dvec2 px = camera.project(corner);
    low = glm::min(low, px);
    high = glm::max(high, px);
  }
  // A lens bends the hull's edges outward by less than a tenth of their span.
  const double bent = bendsLines(camera.distortion()) ? 0.1 : 0.0;
  const glm::dvec2 margin = bent * (high - low) + 2.0;
  const glm::dvec2 size(picture);
  const glm::ivec2 first(glm::floor(glm::clamp(low - margin, glm::dvec2(0.0), size)));
  const glm::ivec2 last(glm::ceil(glm::clamp(high + margin, glm::dvec2(0.0), size)));
  return {first, last - first};
}

ScreenArea areaAround(const BoundingSphere& cameraBall, const tracking::CameraModel& camera) {
  // The points where the ball's tangents meet the plane z = 1, seen along each of the other two
  // axes.
  const auto tangents = [&](double across, double& low, double& high) {
    const double distance = std::hypot(across, cameraBall.centre.z);
    const double middle = std::atan2(across, cameraBall.centre.z);
    const double half = std::asin(std::min(1.0, cameraBall.radiusMetres / distance));
    low = std::tan(middle - half);
    high = std::tan(middle + half);
    return std::abs(middle) + half < 0.45 * std::numbers::pi;
  };
  glm::dvec2 low(0.0);
  glm::dvec2 high(0.0);
  const bool isInFront = cameraBall.radiusMetres < cameraBall.centre.z &&
                         tangents(cameraBall.centre.x, low.x, high.x) &&
                         tangents(cameraBall.centre.y, low.y, high.y);
  if (!isInFront) {
    return {{0, 0}, {camera.imageSize().width, camera.imageSize().height}};
  }
  const std::array<glm::dvec3, 4> corners{glm::dvec3(low, 1.0), glm::dvec3(high.x, low.y, 1.0),
                                          glm::dvec3(low.x, high.y, 1.0), glm::dvec3(high, 1.0)};
  return areaAround(corners, camera);
}

ScreenArea unionOf(const ScreenArea& a, const ScreenArea& b) {
  if (a.isEmpty()) return b;
  if (b.isEmpty()) return a;
  const glm::ivec2 origin = glm::min(a.origin, b.origin);
  return {origin, glm::max(a.origin + a.size, b.origin + b.size) - origin};
}

}  // namespace pleinair::scene
