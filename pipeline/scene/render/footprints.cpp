#include "pipeline/scene/render/footprints.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "pipeline/scene/description/lens.h"

namespace pleinair::scene {
namespace {

/// A rectangle on z = 0 of an attach frame, metres.
struct FloorArea {
  glm::dvec2 low{HUGE_VAL};
  glm::dvec2 high{-HUGE_VAL};
};

FloorArea areaUnder(std::span<const BoundingSphere> spheres, const glm::dmat4& attachFromModel) {
  FloorArea area;
  for (const BoundingSphere& sphere : spheres) {
    const BoundingSphere placed = transformed(sphere, attachFromModel);
    const glm::dvec2 centre(placed.centre);
    area.low = glm::min(area.low, centre - placed.radiusMetres);
    area.high = glm::max(area.high, centre + placed.radiusMetres);
  }
  return area;
}

std::optional<Footprint> seenFrom(const FloorArea& area, const glm::dmat4& cameraFromAttach,
                                  const tracking::CameraModel& camera) {
  const double widest = trustedLensRadius(camera.distortion());
  Footprint footprint;
  for (std::size_t i = 0; i < footprint.px.size(); ++i) {
    const bool isRight = i == 1 || i == 2;
    const glm::dvec4 corner(isRight ? area.high.x : area.low.x, i < 2 ? area.low.y : area.high.y,
                            0.0, 1.0);
    const glm::dvec3 seen(cameraFromAttach * corner);
    if (seen.z < 1e-3 || glm::length(glm::dvec2(seen)) > widest * seen.z) return std::nullopt;
    footprint.px.at(i) = glm::vec2(camera.project(seen));
  }
  return footprint;
}

}  // namespace

void findFootprints(const Scene& scene, const PosedGeometry& geometry, const SceneBodies& bodies,
                    std::span<const std::size_t> visible, const tracking::CameraModel& camera,
                    std::vector<Footprint>& footprints) {
  footprints.clear();
  const auto add = [&](const FloorArea& area, const glm::dmat4& cameraFromAttach) {
    if (footprints.size() == kMaxFootprints || area.low.x >= area.high.x) return;
    const std::optional<Footprint> seen = seenFrom(area, cameraFromAttach, camera);
    if (seen && std::ranges::find(footprints, *seen) == footprints.end()) {
      footprints.push_back(*seen);
    }
  };
  for (const std::size_t i : visible) {
    const SceneModel& model = scene.models[i];
    const auto& moment = bodies.model(i).current;
    if (model.isOccluder || !moment) continue;
    const glm::dmat4& cameraFromAttach = moment->attachment.cameraFromAttach;
    add(areaUnder(geometry.spheres(i), model.attachFromModel), cameraFromAttach);
    const tracking::TagMarker* tag = model.tagId ? scene.findTag(*model.tagId) : nullptr;
    if (tag == nullptr) continue;
    const glm::dvec2 half(0.5 * tag->edgeMetres);
    add({-half, half}, cameraFromAttach);
  }
}

}  // namespace pleinair::scene
