#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/vec2.hpp>
#include <glm/vec4.hpp>

#include "hal/pixel_format.h"

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

/// Features of which motion is told at once.
inline constexpr std::size_t kMostMovedFeatures = 256;

/// Where a feature of the camera's picture was and is, in px of the frame, pixel centres at +0.5.
/// A feature that does not move more than its position trembles has the same place in both frames,
/// to the bit, and what it has moved adds up: nothing is lost of a slow motion.
struct FeatureMotion {
  std::uint32_t id = 0;  ///< the same as long as it is followed
  glm::vec2 then{0.0F};
  glm::vec2 now{0.0F};
  float errorPx = 0.0F;  ///< predicted, of now - then: one standard deviation over both axes
};

/// The motion that most of the picture follows, as a homography of px of the frame.
struct PictureHomography {
  glm::dmat3 nowFromThen{1.0};  ///< the identity, to the bit, while the camera stands still
  double errorPx = 0.0;         ///< predicted, of a point that follows it; as a feature's
};

/// Dense motion at the nodes of a grid: node (i, j) stands for ((i, j) + 0.5) · step.
struct DenseFlow {
  hal::FrameSize nodes;
  glm::vec2 stepPx{1.0F};  ///< of the frame
  /// Row by row: displacement (px of the frame), its predicted error (px), and 0. `forward`: from
  /// the node to where what was there has gone; `backward`: from the node to where what is there
  /// was.
  std::span<const glm::vec4> forward;
  std::span<const glm::vec4> backward;
};

/// Where the picture has not moved: fields of a grid of `fields` over the whole frame, row by row.
struct StaticRegions {
  hal::FrameSize fields;
  /// Predicted error (px) of taking the field for still; kNotStatic where it changes, or has too
  /// little texture to tell.
  std::span<const float> errorPx;
  static constexpr float kNotStatic = 1.0e4F;
};

/// How a camera's picture moved from the frame before to this one, measured in the picture alone.
/// A view of an estimator's buffers, valid until it takes the next frame.
struct ImageMotion {
  hal::FrameSize frameSize;
  std::uint64_t sinceSequence = 0;  ///< the frame before
  /// Nothing that was seen is seen any more (another scene, another size): nothing below holds.
  bool isCut = false;
  std::span<const FeatureMotion> features;
  std::optional<PictureHomography> picture;  ///< where enough features agree
  DenseFlow flow;                            ///< without nodes where it was not estimated
  StaticRegions still;                       ///< likewise
  double noiseLevels = 0.0;  ///< of a pixel's luma, one standard deviation, in 1/255
};

}  // namespace pleinair::tracking
