#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <span>
#include <vector>

#include "pipeline/marks/anchors/anchor.h"
#include "pipeline/measure/anchor_drift.h"
#include "pipeline/measure/input/motion_map.h"

namespace pleinair::measure {

/// The motion of models (ModelMotion::ofModels()) between this frame and earlier ones; null where
/// there is no such frame.
struct ModelMotionOfAnchors {
  const MotionMap* sinceLast = nullptr;  ///< from the previous frame to this one
  const MotionMap* toLast = nullptr;     ///< from this one to the previous one
  const MotionMap* sinceLong = nullptr;  ///< from ten frames before to this one
};

/// Anchors on models over a sequence: means per frame. Only places of models count that are seen in
/// both compared frames, and lie 3 px or more away from outlines: what turns away or comes into
/// sight takes its anchors with it or brings new ones.
struct ModelAnchorSummary {
  std::size_t frames = 0;
  double anchors = 0, births = 0, deaths = 0;
  double turnoverPercent = 0;  ///< births and deaths, relative to the anchors
  /// The mean absolute change of the models' screen area, in per cent of it a frame: as many marks
  /// have to come or go.
  double resizedPercent = 0;
  std::optional<Drift> slip;      ///< from where the surface goes, a frame
  std::optional<Drift> longSlip;  ///< over ten frames
};

/// Compares anchors with the models that they lie on. One thread.
class ModelAnchors {
 public:
  explicit ModelAnchors(cv::Size frame) : frame_(frame) {}

  /// Takes the anchors after the next frame, free slots included.
  void add(std::span<const marks::Anchor> anchors, const ModelMotionOfAnchors& motion);
  /// Nothing if no anchor was on a model.
  std::optional<ModelAnchorSummary> summary() const;

 private:
  /// Whether an anchor is within the border, on a place of a model that the map follows.
  bool isFollowed(const marks::Anchor& anchor, const MotionMap& motion) const;
  void countChanges(std::span<const marks::Anchor> anchors, const MotionMap& sinceLast,
                    const MotionMap& toLast);
  std::optional<Drift> slipSince(std::span<const marks::Anchor> earlier,
                                 std::span<const marks::Anchor> current,
                                 const MotionMap& motion) const;

  cv::Size frame_;
  std::deque<std::vector<marks::Anchor>> past_;  ///< ten at most, the newest last
  std::size_t frames_ = 0;
  double anchors_ = 0, births_ = 0, deaths_ = 0;
  double resized_ = 0;
  MeanDrift slip_, longSlip_;
};

}  // namespace pleinair::measure
