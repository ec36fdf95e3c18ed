#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <utility>

#include <opencv2/core.hpp>

#include "pipeline/measure/input/true_motion.h"

namespace pleinair::measure {

/// Which points of virtual models a frame shows, as they were painted.
struct PaintedModels {
  /// The surface that each pixel shows: an object in the upper bits, a triangle of it
  /// in the others; 0 where the camera's image is seen.
  cv::Mat1i ids;
  static constexpr int kTriangleBits = 22;
  /// Barycentric coordinates of the first two corners of that triangle.
  cv::Mat2f barycentrics;
  /// Where a point of a surface is in this frame, hidden or not (px, pixel centres at whole
  /// numbers); nothing where it is not in front of the camera.
  std::function<std::optional<cv::Point2f>(int id, const cv::Vec2f& barycentrics)> place;

  /// 255 where the picture with models differs from the camera's: on models and their shadows,
  /// which no motion explains.
  cv::Mat1b changed;

  /// 255 on models.
  cv::Mat1b mask() const;
};

/// The true motion of a camera's image with virtual models in it: of each pixel, that of what it
/// shows, a surface of a model or the camera's image. Invalid where this is hidden in the later
/// frame, and close to the outlines of models and to steps of motion within them.
///
/// The motion of a surface comes from its points as posed in both frames, not from motion between
/// successive frames, so that no error adds up. It is visible in the later frame if the surface
/// that is seen there was, in the earlier frame, where it comes from.
class ModelMotion final : public TrueMotion {
 public:
  /// `camera`: the motion of the camera's image, which then is only known there; null if it is
  /// unknown. Must outlive this object.
  explicit ModelMotion(TrueMotion* camera) : camera_(camera) {}

  /// Takes the next frame. Keeps a dozen.
  void add(std::uint64_t frame, PaintedModels models);

  MotionKind kind() const override { return MotionKind::kOther; }
  std::string description() const override;
  /// Precondition, here and below: both frames were added, among the last dozen.
  hal::Result<MotionMap> between(std::uint64_t from, std::uint64_t to) override;

  /// The motion of models alone, in either direction; invalid elsewhere.
  MotionMap ofModels(std::uint64_t from, std::uint64_t to) const;
  /// A truth that forgets the models: the camera's motion everywhere, or none if that is unknown. A
  /// negative control.
  hal::Result<MotionMap> forgettingModels(std::uint64_t from, std::uint64_t to);
  const PaintedModels& models(std::uint64_t frame) const { return recent_.at(frame); }

 private:
  /// Nothing if the camera's motion is unknown.
  hal::Result<const MotionMap*> ofCamera(std::uint64_t from, std::uint64_t to);

  TrueMotion* camera_;
  std::map<std::uint64_t, PaintedModels> recent_;
  std::map<std::pair<std::uint64_t, std::uint64_t>, MotionMap> cameraMaps_;  ///< to the last frame
};

}  // namespace pleinair::measure
