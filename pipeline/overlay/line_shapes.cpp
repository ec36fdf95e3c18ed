#include "pipeline/overlay/line_shapes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

namespace pleinair::overlay {
namespace {

constexpr double kHalfWidthPx = 2.5;
constexpr double kLeastLengthPx = 30.0;
constexpr double kMostLengthPx = 70.0;
constexpr double kLeastRadiusPx = 12.0;
constexpr double kGapPx = 8.0;        // between a part and the arrow around it
constexpr double kLeastHeadPx = 9.0;  // less is no arrow beside its casing
constexpr double kNearestMetres = 0.01;

struct Eye {
  const glm::dmat4& cameraFromModel;
  const tracking::CameraModel& camera;

  std::optional<glm::dvec2> px(const glm::dvec3& point) const {
    const glm::dvec3 at(cameraFromModel * glm::dvec4(point, 1.0));
    if (at.z < kNearestMetres) return std::nullopt;
    return camera.project(at);
  }
  /// Metres of the model's frame that a length in px is at a point.
  double metresOf(double px, const glm::dvec3& point) const {
    const glm::dvec3 at(cameraFromModel * glm::dvec4(point, 1.0));
    const double scale = glm::length(glm::dvec3(cameraFromModel[0]));
    return px * std::max(at.z, kNearestMetres) / (camera.intrinsics().fx * scale);
  }
};

bool isAround(ArrowKind kind) {
  return kind == ArrowKind::kTurn || kind == ArrowKind::kUnscrew || kind == ArrowKind::kScrew;
}

}  // namespace

void LineShapes::addLine(const glm::dvec2& a, const glm::dvec2& b, double halfWidthPx) {
  add({.a = a, .b = b, .halfWidthPx = static_cast<float>(halfWidthPx)});
}

void LineShapes::addArrow(const glm::dvec2& from, const glm::dvec2& to, double halfWidthPx) {
  const double length = glm::length(to - from);
  if (length < 1e-6) return;
  const glm::dvec2 way = (to - from) / length;
  const double head = std::min(4.5 * halfWidthPx, 0.7 * length);
  const glm::dvec2 neck = to - head * way;
  addLine(from, neck, halfWidthPx);
  addHead(neck, way, head);
}

void LineShapes::addHead(const glm::dvec2& neck, const glm::dvec2& along, double lengthPx) {
  const double seen = glm::length(along);
  if (seen < 1e-6) return;
  const glm::dvec2 way = along / seen;
  const glm::dvec2 across(-way.y, way.x);
  add({.a = neck + lengthPx * way,
       .b = neck + 0.62 * lengthPx * across,
       .c = neck - 0.62 * lengthPx * across,
       .halfWidthPx = 0.5F,
       .isTriangle = true});
}

/// Whether there is room for an arrow; then it is taken.
bool LineShapes::takesPlace(const glm::dvec2& px, double apartPx) {
  for (const glm::dvec2& each : arrowPlaces_) {
    if (glm::length(each - px) < apartPx) return false;
  }
  if (arrowPlaces_.size() < kMost) arrowPlaces_.push_back(px);
  return true;
}

void LineShapes::addArrowOf(const Arrow& arrow, const PartShape& shape,
                            const glm::dmat4& cameraFromModel, const tracking::CameraModel& camera,
                            double pxScale, double phase) {
  const std::size_t first = shapes_.size();
  addShapesOf(arrow, shape, cameraFromModel, camera, pxScale, phase);
  if (shapes_.size() == first || arrowBoxes_.size() == kMost) return;
  std::optional<PxBox> box;
  for (std::size_t i = first; i < shapes_.size(); ++i) {
    const LineShape& each = shapes_[i];
    PxBox one{glm::min(each.a, each.b), glm::max(each.a, each.b)};
    if (each.isTriangle) one = boxAround(one, {glm::dvec2(each.c), glm::dvec2(each.c)});
    box = box ? boxAround(*box, one) : one;
  }
  arrowBoxes_.push_back(box->grown(kHalfWidthPx * pxScale));
}

void LineShapes::addShapesOf(const Arrow& arrow, const PartShape& shape,
                             const glm::dmat4& cameraFromModel, const tracking::CameraModel& camera,
                             double pxScale, double phase) {
  const Eye eye{cameraFromModel, camera};
  const glm::dvec3 top = shape.centre + shape.halfLength * shape.axis;
  const std::optional<glm::dvec2> middle = eye.px(shape.centre);
  const std::optional<PxBox> box = boxOf(shape, cameraFromModel, camera);
  if (!middle || !box) return;
  if (isAround(arrow.kind)) {
    // About the axis, as seen from its end: unscrewing goes counter-clockwise.
    const double least = eye.metresOf(kLeastRadiusPx * pxScale, top);
    const double gap = eye.metresOf(kGapPx * pxScale, top);
    const double radius = std::max({1.35 * shape.radius, shape.radius + gap, least});
    const double radiusPx = kLeastRadiusPx * pxScale * radius / std::max(least, 1e-12);
    if (!takesPlace(*middle, 2.6 * radiusPx)) return;
    const double width = std::clamp(0.11 * radiusPx, 1.3 * pxScale, kHalfWidthPx * pxScale);
    const glm::dvec3 other = glm::cross(shape.axis, shape.side);
    const double sense = arrow.kind == ArrowKind::kScrew ? -1.0 : 1.0;
    constexpr int kSteps = 16;
    std::optional<glm::dvec2> before;
    for (int i = 0; i <= kSteps; ++i) {
      const double angle = sense * glm::radians(270.0 * i / kSteps + 90.0 * phase);
      const glm::dvec3 point =
          top + radius * (std::cos(angle) * shape.side + std::sin(angle) * other);
      const std::optional<glm::dvec2> px = eye.px(point);
      if (before && px) {
        if (i == kSteps) {
          addHead(*before, *px - *before, std::max(5.0 * width, kLeastHeadPx * pxScale));
        } else {
          addLine(*before, *px, width);
        }
      }
      before = px;
    }
    return;
  }
  // Along the axis as it is seen, from the part's border on: an arrow towards the viewer, which
  // would lie on the part, is turned aside that far.
  const std::optional<glm::dvec2> ahead =
      eye.px(shape.centre + (shape.halfLength + shape.radius) * shape.axis);
  if (!ahead) return;
  glm::dvec2 way = *ahead - *middle;
  const double seen = glm::length(way);
  way = seen > 2.0 ? way / seen : glm::dvec2(0.0, 1.0);
  const glm::dvec2 half = 0.5 * box->size();
  const double toBorder =
      std::min(half.x / std::max(std::abs(way.x), 1e-6), half.y / std::max(std::abs(way.y), 1e-6));
  const glm::dvec2 inner = box->centre() + (toBorder + 5.0 * pxScale) * way;
  // Not out of the picture.
  const glm::dvec2 size(camera.imageSize().width, camera.imageSize().height);
  double length = std::clamp(seen, kLeastLengthPx * pxScale, kMostLengthPx * pxScale);
  for (int i = 0; i < 2; ++i) {
    if (std::abs(way[i]) < 1e-6) continue;
    const double room = (way[i] > 0.0 ? size[i] - inner[i] : inner[i]) - 6.0 * pxScale;
    length = std::min(length, room / std::abs(way[i]));
  }
  length = std::max(length, 0.5 * kLeastLengthPx * pxScale);
  const glm::dvec2 outer = inner + length * way;
  // Parts that leave to either side have arrows that are far apart, however near they are.
  if (!takesPlace(0.5 * (inner + outer), 1.2 * kLeastLengthPx * pxScale)) return;
  if (arrow.kind == ArrowKind::kPull) {
    addArrow(inner, outer, 1.3 * kHalfWidthPx * pxScale);
  } else {
    addArrow(outer, inner, 1.3 * kHalfWidthPx * pxScale);
  }
}

}  // namespace pleinair::overlay
