#include "pipeline/overlay/part_shape.h"

#include <algorithm>
#include <limits>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace pleinair::overlay {
namespace {

constexpr double kNearestMetres = 0.01;

/// Unit length, or `otherwise` where it has none: a part may be flattened.
glm::dvec3 unit(const glm::dvec3& v, const glm::dvec3& otherwise) {
  const double length = glm::length(v);
  return length > 1e-12 ? v / length : otherwise;
}

}  // namespace

PartShape shapeOf(const scene::Model& model, std::size_t index) {
  const scene::ModelPart& part = model.parts[index];
  glm::dvec3 low(std::numeric_limits<double>::max());
  glm::dvec3 high(-low);
  for (std::size_t i = 0; i < part.surfaceCount; ++i) {
    for (const scene::MeshVertex& vertex : model.surfaces[part.firstSurface + i].mesh.vertices) {
      low = glm::min(low, glm::dvec3(vertex.position));
      high = glm::max(high, glm::dvec3(vertex.position));
    }
  }
  if (low.x > high.x) low = high = glm::dvec3(0.0);
  const glm::dmat4& place = part.modelFromPart;
  const glm::dvec3 half = 0.5 * (high - low);
  PartShape shape;
  shape.centre = glm::dvec3(place * glm::dvec4(0.5 * (low + high), 1.0));
  for (int i = 0; i < 3; ++i) {
    const glm::dvec3 column(place[i]);
    shape.ownAxes[i] = unit(column, glm::dmat3(1.0)[i]);
    shape.halfSize[i] = half[i] * glm::length(column);
  }
  for (std::size_t i = 0; i < shape.corners.size(); ++i) {
    const glm::dvec3 corner((i & 1) != 0 ? high.x : low.x, (i & 2) != 0 ? high.y : low.y,
                            (i & 4) != 0 ? high.z : low.z);
    shape.corners[i] = glm::dvec3(place * glm::dvec4(corner, 1.0));
  }
  return alongAxis(shape, {0.0, 0.0, 1.0});
}

PartShape alongAxis(const PartShape& shape, const glm::dvec3& axis) {
  const glm::dvec3 size = glm::abs(axis);
  const int along = size.x > 0.5 ? 0 : size.y > 0.5 ? 1 : 2;
  const int side = (along + 1) % 3;
  PartShape turned = shape;
  turned.axis = axis[along] * shape.ownAxes[along];
  turned.side = shape.ownAxes[side];
  turned.halfLength = shape.halfSize[along];
  turned.radius = std::max(shape.halfSize[side], shape.halfSize[(along + 2) % 3]);
  return turned;
}

double PxBox::shared(const PxBox& other) const {
  const glm::dvec2 both = glm::min(high, other.high) - glm::max(low, other.low);
  return std::max(0.0, both.x) * std::max(0.0, both.y);
}

PxBox boxAround(const PxBox& a, const PxBox& b) {
  return {glm::min(a.low, b.low), glm::max(a.high, b.high)};
}

std::optional<PxBox> boxOf(const PartShape& shape, const glm::dmat4& cameraFromModel,
                           const tracking::CameraModel& camera) {
  PxBox box{glm::dvec2(std::numeric_limits<double>::max()),
            glm::dvec2(-std::numeric_limits<double>::max())};
  for (const glm::dvec3& corner : shape.corners) {
    const glm::dvec3 at(cameraFromModel * glm::dvec4(corner, 1.0));
    if (at.z < kNearestMetres) return std::nullopt;
    const glm::dvec2 px = camera.project(at);
    box = {glm::min(box.low, px), glm::max(box.high, px)};
  }
  return box;
}

}  // namespace pleinair::overlay
