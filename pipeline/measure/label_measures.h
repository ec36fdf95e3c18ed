#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include <opencv2/core.hpp>

#include "hal/clock.h"
#include "pipeline/measure/mean.h"

namespace pleinair::measure {

/// How long it took until a mover that had just come was labelled.
struct Detection {
  std::uint64_t frame = 0;   ///< in which it first had a noticeable size
  std::uint64_t frames = 0;  ///< until at least half of it was labelled, or else until it had gone
  hal::Duration time{};
  bool isFound = false;
};

/// How well a painter's labels of movers agree with true masks (docs/measuring.md).
struct LabelSummary {
  /// Intersection over union, over frames with a mover of noticeable size.
  std::optional<double> meanIou, worstIou;
  std::uint64_t worstFrame = 0;
  std::vector<Detection> detections;
  /// The share of places away from movers whose label changes from one frame to the next, percent.
  std::optional<double> flipsPercent;
  bool hasMovers = false;
  /// Mean IoU of the true masks with the same displaced (mover_masks.h): a negative control.
  std::optional<double> displacedIou;
};

/// Compares labels with true masks, frame by frame. One thread.
class LabelMeasures {
 public:
  /// Takes the next frame. `labels`: 255 on what the painter takes for movers; a texel is 2×2 px.
  /// `truth`: 255 on movers, of the full size.
  void add(std::uint64_t frame, hal::TimePoint time, const cv::Mat1b& labels,
           const cv::Mat1b& truth);
  LabelSummary total() const;
  /// The IoU of the last frame; nothing where it showed no mover of noticeable size.
  std::optional<double> lastIou() const { return lastIou_; }

 private:
  void overlap(std::uint64_t frame, const cv::Mat1b& labels, const cv::Mat1b& truth);
  void detect(std::uint64_t frame, hal::TimePoint time, const cv::Mat1b& labels,
              const cv::Mat1b& truth);
  void compareWithLast(const cv::Mat1b& labels, const cv::Mat1b& truth);

  enum class Presence { kUnknown, kNone, kAwaited, kFound };
  Presence presence_ = Presence::kUnknown;
  hal::TimePoint cameAt_;
  LabelSummary summary_;
  std::optional<double> lastIou_;
  Mean iou_;
  Mean displacedIou_;
  Mean flips_;
  cv::Mat1b lastLabels_;
  cv::Mat1b lastFar_;
};

}  // namespace pleinair::measure
