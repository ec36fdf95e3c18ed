#pragma once

#include <optional>

#include <glm/geometric.hpp>
#include <glm/vec2.hpp>

#include "pipeline/tracking/motion/image_motion.h"

namespace pleinair::tracking {

/// The turn, zoom and shift that take points to others with the least squares (Umeyama,
/// "Least-squares estimation of transformation parameters", 1991), from the sums of their pairs.
class SimilarityFit {
 public:
  void add(glm::dvec2 from, glm::dvec2 to, double weight = 1.0) {
    weights_ += weight;
    from_ += weight * from;
    to_ += weight * to;
    products_ += weight * PlaneSimilarity::product({from.x, -from.y}, to);
    squares_ += weight * glm::dot(from, from);
  }

  /// Nothing if the points are none, or all the same.
  std::optional<PlaneSimilarity> nearest() const {
    if (weights_ <= 0.0) return std::nullopt;
    const glm::dvec2 from = from_ / weights_;
    const glm::dvec2 to = to_ / weights_;
    const double squares = squares_ - weights_ * glm::dot(from, from);
    if (squares <= 1e-12 * squares_) return std::nullopt;  // no more than rounding
    const glm::dvec2 products =
        products_ - weights_ * PlaneSimilarity::product({from.x, -from.y}, to);
    PlaneSimilarity fit{.linear = products / squares};
    fit.shift = to - PlaneSimilarity::product(fit.linear, from);
    return fit;
  }

 private:
  double weights_ = 0.0;
  glm::dvec2 from_{0.0};
  glm::dvec2 to_{0.0};
  glm::dvec2 products_{0.0};
  double squares_ = 0.0;
};

}  // namespace pleinair::tracking
