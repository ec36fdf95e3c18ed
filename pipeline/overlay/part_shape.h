#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>

#include <glm/mat3x3.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "pipeline/scene/models/model.h"
#include "pipeline/tracking/camera/camera_model.h"

namespace pleinair::overlay {

/// A part at rest as arrows and labels see it: a box along the part's own axes. Metres, in the
/// model's frame.
struct PartShape {
  glm::dvec3 centre{0.0};
  /// The part's own z axis, or another one (alongAxis()), unit length: screws turn about it.
  glm::dvec3 axis{0.0, 0.0, 1.0};
  glm::dvec3 side{1.0, 0.0, 0.0};  ///< across the axis, unit length
  double halfLength = 0.0;         ///< along the axis
  double radius = 0.0;             ///< across it
  std::array<glm::dvec3, 8> corners{};
  glm::dmat3 ownAxes{1.0};   ///< the part's x, y and z axes, unit length
  glm::dvec3 halfSize{0.0};  ///< along them
};

/// The shape of a part; skins and morph targets are not looked at.
PartShape shapeOf(const scene::Model& model, std::size_t part);

/// The shape with another of the part's own axes in the place of z. `axis`: x, y or z, or the
/// opposite of one, as a unit vector in the part's frame.
PartShape alongAxis(const PartShape& shape, const glm::dvec3& axis);

/// A rectangle in pixels: low and high corner.
struct PxBox {
  glm::dvec2 low{0.0};
  glm::dvec2 high{0.0};

  glm::dvec2 size() const { return high - low; }
  glm::dvec2 centre() const { return 0.5 * (low + high); }
  bool isEmpty() const { return high.x <= low.x || high.y <= low.y; }
  PxBox grown(double px) const { return {low - px, high + px}; }
  bool overlaps(const PxBox& other) const {
    return low.x < other.high.x && other.low.x < high.x && low.y < other.high.y &&
           other.low.y < high.y;
  }
  /// Area of what both cover.
  double shared(const PxBox& other) const;
  bool holds(const PxBox& other) const {
    return low.x <= other.low.x && low.y <= other.low.y && other.high.x <= high.x &&
           other.high.y <= high.y;
  }
};
PxBox boxAround(const PxBox& a, const PxBox& b);

/// The box around a part in the image; nothing where any of it is behind the camera.
std::optional<PxBox> boxOf(const PartShape& shape, const glm::dmat4& cameraFromModel,
                           const tracking::CameraModel& camera);

}  // namespace pleinair::overlay
