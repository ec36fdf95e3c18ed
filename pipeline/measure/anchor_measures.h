#pragma once

#include <cstddef>
#include <deque>
#include <optional>
#include <span>
#include <vector>

#include <opencv2/core.hpp>

#include "pipeline/marks/anchor.h"
#include "pipeline/measure/input/motion_map.h"
#include "pipeline/measure/mean.h"

namespace pleinair::measure {

/// How far anchors are from where the true motion has taken what they were on, px.
struct Drift {
  double median = 0;
  double most = 0;  ///< of 95 % of them
  double rms = 0;
};

/// What the engine knows of itself: its anchors in one frame, against the one before.
struct AnchorFrame {
  std::size_t alive = 0, births = 0, deaths = 0;
  std::size_t inner = 0, innerBirths = 0, innerDeaths = 0;  ///< away from the border
  std::size_t moved = 0;                                    ///< by any amount
  std::optional<Drift> drift;                               ///< since the frame before
  std::optional<Drift> longDrift;                           ///< since ten frames before
};

/// The same over a sequence: means a frame.
struct AnchorSummary {
  std::size_t frames = 0;
  double alive = 0, births = 0, deaths = 0;
  double innerBirths = 0, innerDeaths = 0;
  double innerTurnoverPercent = 0;  ///< births and deaths away from the border, of the marks there
  double moved = 0;
  /// Of marks away from the border, from the share that dies a frame. Nothing where it would be
  /// longer than the frames that were seen: half of the marks outlive those.
  std::optional<double> halfLifeFrames;
  std::optional<Drift> drift, longDrift;
  double perCell = 0, spreadPerCell = 0, emptyCellsPercent = 0;  ///< of the grid of 8×8 px
};

/// Follows the anchors of a style, slot by slot.
class AnchorMeasures {
 public:
  explicit AnchorMeasures(cv::Size frame) : frame_(frame) {}

  /// The anchors after the next frame, free slots too; how the picture moved to it from the frame
  /// before, and from ten before, where that is known.
  void add(std::span<const marks::Anchor> anchors, const MotionMap* sinceLast,
           const MotionMap* sinceLong);

  /// All but the first, which has none to be compared with.
  const std::vector<AnchorFrame>& frames() const { return frames_; }
  /// Of the frames from `first` of frames() on. Nothing where no anchors were seen.
  std::optional<AnchorSummary> total(std::size_t first = 0) const;

 private:
  AnchorFrame compare(std::span<const marks::Anchor> anchors) const;
  std::optional<Drift> driftSince(std::span<const marks::Anchor> then,
                                  std::span<const marks::Anchor> now,
                                  const MotionMap* motion) const;
  void countCells(std::span<const marks::Anchor> anchors);
  bool isInner(const marks::Anchor& anchor) const;

  cv::Size frame_;
  std::vector<AnchorFrame> frames_;
  std::deque<std::vector<marks::Anchor>> past_;  ///< a dozen at most, the newest last
  Mean perCell_, squarePerCell_, emptyCells_;
};

}  // namespace pleinair::measure
