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

/// A turn, zoom and shift of the image plane: p ↦ linear · p + shift, with the product of complex
/// numbers (x + iy). `linear` is scale · (cos, sin) of the angle.
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
  /// Applies `second`, then `first`.
  friend PlaneSimilarity operator*(const PlaneSimilarity& first, const PlaneSimilarity& second) {
    return {product(first.linear, second.linear), first(second.shift)};
  }
};

/// Most features whose motion is reported in one frame.
inline constexpr std::size_t kMaxMovedFeatures = 256;

/// Position of a feature of the camera image in the previous frame and in this one: px of the
/// frame, pixel centres at +0.5. A feature that moves less than its position jitters has exactly
/// the same position in both frames; its motion accumulates meanwhile, so that slow motion is not
/// lost.
struct FeatureMotion {
  std::uint32_t id = 0;  ///< constant while the feature is followed
  glm::vec2 previous{0.0F};
  glm::vec2 current{0.0F};
  /// Predicted error of the displacement: one standard deviation over both axes.
  float errorPx = 0.0F;
};

/// The dominant motion of the image, as a homography of px of the frame.
struct ImageHomography {
  glm::dmat3 currentFromPrevious{1.0};  ///< exactly the identity while the camera stands still
  double errorPx = 0.0;  ///< predicted error of a point that follows it; see FeatureMotion::errorPx
};

/// Dense motion at the nodes of a grid: node (i, j) stands for ((i, j) + 0.5) · step.
struct DenseFlow {
  hal::FrameSize nodes;
  glm::vec2 stepPx{1.0F};  ///< px of the frame
  /// Row by row: displacement (px of the frame), its predicted error (px), and 0. `forward` goes
  /// from the node's position in the previous frame to its position in this one; `backward` goes
  /// from the node's position in this frame to its position in the previous one.
  std::span<const glm::vec4> forward;
  std::span<const glm::vec4> backward;
};

/// Static regions of the image: the cells of a grid of `fields` cells over the frame, row by row.
struct StaticRegions {
  hal::FrameSize fields;
  /// Predicted error (px) of treating the cell as static; kNotStatic where it changes or has too
  /// little texture to decide.
  std::span<const float> errorPx;
  static constexpr float kNotStatic = 1.0e4F;
};

/// The noise of a pixel, in levels, that is assumed where it was not measured.
inline constexpr double kUsualNoiseLevels = 2.0;

/// Motion of a camera image from the previous frame to this one, measured in the image alone.
/// Refers to an estimator's buffers and is valid until the estimator takes the next frame.
struct ImageMotion {
  hal::FrameSize frameSize;
  std::uint64_t sinceSequence = 0;  ///< of the previous frame
  /// True when nothing seen before is visible any more (another scene or size); then nothing below
  /// applies.
  bool isCut = false;
  std::span<const FeatureMotion> features;
  std::optional<ImageHomography> picture;  ///< empty where too few features agree and
                                           ///< the camera is not known to stand
  DenseFlow flow;                          ///< without nodes where it was not estimated
  StaticRegions still;                     ///< without cells where they were not detected
  double noiseLevels = 0.0;                ///< standard deviation of a pixel's luma, in 1/255
};

}  // namespace pleinair::tracking
