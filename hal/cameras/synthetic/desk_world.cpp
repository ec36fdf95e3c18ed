#include "hal/cameras/synthetic/desk_world.h"

#include <cmath>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "hal/cameras/synthetic/desk_canvas.h"
#include "hal/cameras/synthetic/desk_painting.h"
#include "hal/cameras/synthetic/mip_texture.h"

namespace pleinair::hal::synthetic {
namespace {

std::optional<glm::dvec3> planeAlong(const Ray& ray, double z) {
  const double rise = ray.direction.z;
  const double t = (z - ray.origin.z) / rise;
  if (rise == 0 || t <= 0) return std::nullopt;
  return ray.origin + t * ray.direction;
}

}  // namespace

bool isOnDesk(glm::dvec2 point) {
  const glm::dvec2 fromCentre = glm::abs(point - (kDeskLow + kDeskHigh) / 2.0);
  const glm::dvec2 half = (kDeskHigh - kDeskLow) / 2.0;
  const glm::dvec2 d = glm::max(fromCentre - half + kDeskCornerRadius, 0.0);
  return glm::length(d) <= kDeskCornerRadius;
}

std::optional<glm::dvec3> surfaceAlong(const Ray& ray) {
  const std::optional<glm::dvec3> onDeskPlane = planeAlong(ray, 0);
  if (onDeskPlane && isOnDesk(glm::dvec2(*onDeskPlane))) return onDeskPlane;
  return planeAlong(ray, kFloorZ);
}

glm::vec3 hazeLinearRgb() {
  static const glm::vec3 kHaze = linearFromSrgb(0x6f6a66);
  return kHaze;
}

glm::vec3 floorLinearRgb(glm::vec2 point) {
  static const glm::vec3 kLit = linearFromSrgb(0xa59c8f);
  const glm::vec2 centre = glm::vec2(kDeskLow + kDeskHigh) / 2.0F;
  const glm::vec2 half = glm::vec2(kDeskHigh - kDeskLow) / 2.0F;
  const glm::vec2 shadowShift(0.18F, -0.22F);
  const float fromShadow = boxDistance(point - centre - shadowShift, half, 0.1F);
  const float shadow = 0.62F * (1 - glm::smoothstep(-0.25F, 0.55F, fromShadow));
  const glm::vec2 fromLamp = point - glm::vec2(-0.6F, 1.3F);
  const float pool = 0.72F + 0.35F * std::exp(-glm::dot(fromLamp, fromLamp) / 3.0F);
  const float far = 1 - std::exp(-glm::length(point) / 9.0F);
  return glm::mix(kLit * pool * (1 - shadow), hazeLinearRgb(), far);
}

}  // namespace pleinair::hal::synthetic
