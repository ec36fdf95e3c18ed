#pragma once

#include <cmath>

#include <glm/geometric.hpp>
#include <glm/vec2.hpp>

namespace pleinair::tracking {

/// A turn, zoom and shift of a picture's plane: p ↦ linear · p + shift, where the product is that
/// of complex numbers (x + iy): `linear` is scale · (cos, sin) of the angle.
struct PlaneSimilarity {
  glm::dvec2 linear{1.0, 0.0};
  glm::dvec2 shift{0.0};  ///< px

  static glm::dvec2 product(glm::dvec2 a, glm::dvec2 b) {
    return {a.x * b.x - a.y * b.y, a.x * b.y + a.y * b.x};
  }
  glm::dvec2 operator()(glm::dvec2 p) const { return product(linear, p) + shift; }
  double scale() const { return glm::length(linear); }
  double angleRad() const { return std::atan2(linear.y, linear.x); }

  /// Precondition: scale() > 0.
  PlaneSimilarity inverse() const {
    const glm::dvec2 back = glm::dvec2(linear.x, -linear.y) / glm::dot(linear, linear);
    return {back, -product(back, shift)};
  }
  /// `second` first, then `first`.
  friend PlaneSimilarity operator*(const PlaneSimilarity& first, const PlaneSimilarity& second) {
    return {product(first.linear, second.linear), first(second.shift)};
  }
};

}  // namespace pleinair::tracking
