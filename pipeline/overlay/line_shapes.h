#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>

#include "pipeline/overlay/overlay_content.h"
#include "pipeline/overlay/part_shape.h"
#include "pipeline/tracking/camera/camera_model.h"

namespace pleinair::overlay {

/// A thick line with round ends, or a filled triangle (an arrow's head), in px of the picture.
struct LineShape {
  glm::vec2 a{0.0F};
  glm::vec2 b{0.0F};
  glm::vec2 c{0.0F};         ///< of a triangle
  float halfWidthPx = 1.0F;  ///< of a line; a triangle grows by it
  bool isTriangle = false;
};

/// The lines of a frame: arrows and leader lines. Keeps its memory.
class LineShapes {
 public:
  static constexpr std::size_t kMost = 512;

  void clear() {
    shapes_.clear();
    arrowPlaces_.clear();
    arrowBoxes_.clear();
  }
  std::span<const LineShape> all() const { return shapes_; }
  /// Around each arrow that addArrowOf() has drawn.
  std::span<const PxBox> arrowBoxes() const { return arrowBoxes_; }
  void addLine(const glm::dvec2& a, const glm::dvec2& b, double halfWidthPx);
  /// A line with a head at `to`.
  void addArrow(const glm::dvec2& from, const glm::dvec2& to, double halfWidthPx);

  /// The arrow of a part, beside it along its axis, or around that. One that would run into an
  /// earlier one is left out: of a row of bolts some have arrows. `pxScale`: widths and least
  /// lengths are for a picture 640 px wide; `phase`: 0 … 1, how far its movement has gone.
  void addArrowOf(const Arrow& arrow, const PartShape& shape, const glm::dmat4& cameraFromModel,
                  const tracking::CameraModel& camera, double pxScale, double phase);

  LineShapes() {
    shapes_.reserve(kMost);
    arrowPlaces_.reserve(kMost);
    arrowBoxes_.reserve(kMost);
  }

 private:
  void addShapesOf(const Arrow& arrow, const PartShape& shape, const glm::dmat4& cameraFromModel,
                   const tracking::CameraModel& camera, double pxScale, double phase);
  /// A head from its neck on.
  void addHead(const glm::dvec2& neck, const glm::dvec2& along, double lengthPx);
  bool takesPlace(const glm::dvec2& px, double apartPx);
  void add(const LineShape& shape) {
    if (shapes_.size() < kMost) shapes_.push_back(shape);
  }
  std::vector<LineShape> shapes_;
  std::vector<glm::dvec2> arrowPlaces_;
  std::vector<PxBox> arrowBoxes_;
};

}  // namespace pleinair::overlay
