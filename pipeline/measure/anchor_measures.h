#pragma once

#include <cstddef>
#include <deque>
#include <optional>
#include <span>
#include <vector>

#include <opencv2/core.hpp>

#include "pipeline/marks/anchors/anchor.h"
#include "pipeline/measure/anchor_drift.h"
#include "pipeline/measure/input/motion_map.h"
#include "pipeline/measure/mean.h"

namespace pleinair::measure {

/// Internal state of the engine: its anchors in one frame, compared with the previous one.
struct AnchorFrame {
  std::size_t alive = 0, births = 0, deaths = 0;
  std::size_t inner = 0, innerBirths = 0, innerDeaths = 0;  ///< away from the border
  std::size_t moved = 0;                                    ///< by any amount
  std::optional<Drift> drift;                               ///< since the previous frame
  std::optional<Drift> longDrift;                           ///< over ten frames
};

/// The same over a sequence: means per frame.
struct AnchorSummary {
  std::size_t frames = 0;
  double alive = 0, births = 0, deaths = 0;
  double innerBirths = 0, innerDeaths = 0;
  /// Births and deaths away from the border, relative to the marks there.
  double innerTurnoverPercent = 0;
  double moved = 0;
  /// Half-life of marks away from the border, from the share that dies per frame. Nothing if it is
  /// longer than the measured sequence.
  std::optional<double> halfLifeFrames;
  std::optional<Drift> drift, longDrift;
  double perCell = 0, spreadPerCell = 0, emptyCellsPercent = 0;  ///< on the grid of 8×8 px
};

/// Follows the anchors of a style, slot by slot.
class AnchorMeasures {
 public:
  explicit AnchorMeasures(cv::Size frame) : frame_(frame) {}

  /// Takes the anchors after the next frame, free slots included, and the motion to this frame from
  /// the previous one and from ten frames before, where it is known.
  /// Births and deaths in `ignored` (255), if given, do not count.
  void add(std::span<const marks::Anchor> anchors, const MotionMap* sinceLast,
           const MotionMap* sinceLong, const cv::Mat1b* ignored = nullptr);

  /// All frames but the first, which has no previous one.
  const std::vector<AnchorFrame>& frames() const { return frames_; }
  /// Summary of frames() from index `first` on; nothing if there were no anchors.
  std::optional<AnchorSummary> total(std::size_t first = 0) const;

 private:
  AnchorFrame compare(std::span<const marks::Anchor> anchors, const cv::Mat1b* ignored) const;
  std::optional<Drift> driftSince(std::span<const marks::Anchor> previous,
                                  std::span<const marks::Anchor> current,
                                  const MotionMap* motion) const;
  void countCells(std::span<const marks::Anchor> anchors);
  bool isInner(const marks::Anchor& anchor) const;

  cv::Size frame_;
  std::vector<AnchorFrame> frames_;
  std::deque<std::vector<marks::Anchor>> past_;  ///< a dozen at most, the newest last
  Mean perCell_, squarePerCell_, emptyCells_;
};

}  // namespace pleinair::measure
