#include "pipeline/scene/shadow_plan.h"

#include <algorithm>
#include <cmath>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace pleinair::scene {
namespace {

constexpr double kMostShear = 1.6;     // a light lower than 32° casts as if it were there
constexpr double kMostDistance = 2.0;  // to the plane, in radii
constexpr double kMargin = 1.2;        // for the penumbra
constexpr double kBelow = 0.03;        // of the height, that still counts as on the plane
constexpr double kStepsADoubling = 4.0;

struct Bounds {
  glm::dvec2 low{HUGE_VAL};
  glm::dvec2 high{-HUGE_VAL};

  void add(const glm::dvec2& centre, const glm::dvec2& reach) {
    low = glm::min(low, centre - reach);
    high = glm::max(high, centre + reach);
  }
};

bool contains(const ShadowPlan& plan, const Bounds& bounds) {
  return glm::all(glm::greaterThanEqual(bounds.low, plan.centre - plan.half)) &&
         glm::all(glm::lessThanEqual(bounds.high, plan.centre + plan.half));
}

}  // namespace

glm::dmat4 ShadowPlan::mapFromAttach() const {
  const double below = kBelow * height;
  glm::dmat4 map(1.0);
  map[0][0] = 1.0 / half;
  map[1][1] = 1.0 / half;
  map[2] = glm::dvec4(shear / half, 2.0 / (height + below), 0.0);
  map[3] = glm::dvec4(-centre / half, 2.0 * below / (height + below) - 1.0, 1.0);
  return map;
}

std::optional<ShadowPlan> planShadow(std::span<const BoundingSphere> spheres,
                                     const glm::dvec3& towardKey,
                                     const std::optional<ShadowPlan>& before) {
  ShadowPlan plan;
  const double up = std::max(towardKey.z, 1e-3);
  plan.shear = -glm::dvec2(towardKey) / up;
  const double shear = glm::length(plan.shear);
  if (shear > kMostShear) plan.shear *= kMostShear / shear;
  Bounds bounds;
  for (const BoundingSphere& sphere : spheres) {
    const double r = sphere.radiusMetres;
    const bool isNear =
        sphere.centre.z - r < kMostDistance * r && sphere.centre.z + r > 0.0 && r > 0.0;
    if (!isNear) continue;
    const glm::dvec2 foot(sphere.centre);
    bounds.add(foot, glm::dvec2(r));
    bounds.add(foot + std::max(sphere.centre.z, 0.0) * plan.shear,
               r * glm::sqrt(1.0 + plan.shear * plan.shear));
    plan.height = std::max(plan.height, sphere.centre.z + r);
  }
  if (!(plan.height > 0.0)) return std::nullopt;
  const glm::dvec2 extent = 0.5 * kMargin * (bounds.high - bounds.low);
  const double half = std::max(extent.x, extent.y);
  const bool fits = before && contains(*before, bounds) && before->half < 1.5 * half &&
                    before->height >= plan.height && before->height < 1.5 * plan.height;
  if (fits) {
    plan.half = before->half;
    plan.centre = before->centre;
    plan.height = before->height;
    return plan;
  }
  plan.height = std::exp2(std::ceil(kStepsADoubling * std::log2(plan.height)) / kStepsADoubling);
  plan.half = std::exp2(std::ceil(kStepsADoubling * std::log2(half)) / kStepsADoubling);
  plan.centre = plan.texel() * glm::round(0.5 * (bounds.low + bounds.high) / plan.texel());
  return plan;
}

}  // namespace pleinair::scene
