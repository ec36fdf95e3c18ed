#include "hal/cameras/synthetic/world/occlusion.h"

#include <algorithm>
#include <limits>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace pleinair::hal::synthetic {
namespace {

/// Whether the whole tile lies outside one plane of an occluder.
bool isOutside(const Tile& tile, const glm::vec4& plane) {
  const glm::vec3 normal(plane);
  if (!tile.isFlat) return glm::dot(normal, tile.centre) - plane.w > tile.radius;
  return std::ranges::all_of(
      tile.corners, [&](const glm::vec3& corner) { return glm::dot(normal, corner) > plane.w; });
}

float distanceTo(const Tile& tile, const glm::vec4& plane) {
  return glm::dot(glm::vec3(plane), tile.centre) - plane.w - tile.radius;
}

}  // namespace

float entryDistance(const Occluder& occluder, glm::vec3 origin, glm::vec3 direction) {
  const glm::vec3 toCentre = occluder.centre - origin;
  const glm::vec3 apart = glm::cross(toCentre, direction);
  if (glm::dot(apart, apart) > occluder.radius * occluder.radius * glm::dot(direction, direction)) {
    return std::numeric_limits<float>::infinity();
  }
  float in = 0;
  float out = std::numeric_limits<float>::infinity();
  for (const glm::vec4& plane : occluder.planes) {
    const glm::vec3 normal(plane);
    const float towards = glm::dot(normal, direction);
    const float above = glm::dot(normal, origin) - plane.w;
    if (towards == 0) {
      if (above > 0) return std::numeric_limits<float>::infinity();
      continue;
    }
    const float t = -above / towards;
    if (towards < 0) {
      in = std::max(in, t);
    } else {
      out = std::min(out, t);
    }
    if (in >= out) return std::numeric_limits<float>::infinity();
  }
  return in;
}

bool isBlocked(const Occluders& near, glm::vec3 origin, glm::vec3 direction, float distance) {
  return std::ranges::any_of(near, [&](const Occluder* each) {
    return entryDistance(*each, origin, direction) < distance;
  });
}

bool isInside(const Occluder& occluder, glm::vec3 point) {
  return std::ranges::all_of(occluder.planes, [point](const glm::vec4& plane) {
    return glm::dot(glm::vec3(plane), point) < plane.w;
  });
}

Occluders between(const Occluders& occluders, const Tile& tile, glm::vec3 to, float farRadius) {
  Occluders near;
  const glm::vec3 along = to - tile.centre;
  for (const Occluder* each : occluders) {
    const float t = glm::clamp(glm::dot(each->centre - tile.centre, along) / glm::dot(along, along),
                               0.0F, 1.0F);
    const float reach = each->radius + glm::mix(tile.radius, farRadius, t);
    const glm::vec3 apart = each->centre - tile.centre - along * t;
    const bool isAside = std::ranges::any_of(each->planes, [&](const glm::vec4& plane) {
      return isOutside(tile, plane) && glm::dot(glm::vec3(plane), to) - plane.w > farRadius;
    });
    if (glm::dot(apart, apart) < reach * reach && !isAside) near.push_back(each);
  }
  return near;
}

Occluders around(const Occluders& occluders, const Tile& tile, float withinMetres) {
  Occluders near;
  for (const Occluder* each : occluders) {
    const float reach = each->radius + tile.radius + withinMetres;
    const glm::vec3 apart = each->centre - tile.centre;
    if (glm::dot(apart, apart) >= reach * reach) continue;
    const bool isBehind = std::ranges::any_of(each->planes, [&](const glm::vec4& plane) {
      return isOutside(tile, plane) && (glm::dot(glm::vec3(plane), tile.normal) > 0.9999F ||
                                        (tile.isFlat && distanceTo(tile, plane) > withinMetres));
    });
    if (!isBehind) near.push_back(each);
  }
  return near;
}

}  // namespace pleinair::hal::synthetic
