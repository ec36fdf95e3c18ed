#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "hal/error.h"
#include "pipeline/measure/anchor_measures.h"
#include "pipeline/measure/flatness.h"
#include "pipeline/measure/input/true_motion.h"
#include "pipeline/measure/mean.h"
#include "pipeline/measure/negative_controls.h"
#include "pipeline/measure/output_measures.h"

namespace pleinair::measure {

/// xFLK: how a painting and its controls flicker on a scene that stands still before a noisy
/// sensor.
class StillMeasures {
 public:
  explicit StillMeasures(cv::Size frame) : controls_(frame) {}

  /// The next frame, of the constructor's size, RGB in [0, 1].
  void add(const cv::Mat3f& input, const cv::Mat3f& output);
  /// How much a subject flickers beside the input. Nothing of fewer than two frames, or without
  /// noise.
  std::optional<double> flicker(Subject subject) const;

 private:
  ControlPainter controls_;
  PerSubject<cv::Mat3f> last_;
  PerSubject<Mean> flickers_;
  std::uint64_t frames_ = 0;
};

/// What a painted sequence and its controls read, while the frames go by.
class SequenceMeasures {
 public:
  /// `motion` is null where it is not known; else it outlives this.
  SequenceMeasures(cv::Size frame, TrueMotion* motion);

  /// The next frame, and the anchors that its marks hang on, where it has any. `index` counts the
  /// input's frames and rises by one. Errors: of the motion's files.
  hal::Result<void> add(std::uint64_t index, const cv::Mat3f& input, const cv::Mat3f& output,
                        std::span<const marks::Anchor> anchors);

  const OutputMeasures& of(Subject subject) const { return outputs_[subject]; }
  const AnchorMeasures& anchors() const { return anchors_; }
  std::optional<Flatness> flatness() const { return flatness_.total(); }
  /// All but xFLK.
  PerSubject<Measures> totals() const;
  MotionKind motionKind() const;

 private:
  /// Nothing where there is no motion, or no such frame was measured.
  hal::Result<std::optional<MotionMap>> motionOver(std::uint64_t index, std::size_t lag) const;

  TrueMotion* motion_;
  ControlPainter controls_;
  PerSubject<OutputMeasures> outputs_;
  AnchorMeasures anchors_;
  FlatnessMeasures flatness_;
  std::size_t frames_ = 0;
};

}  // namespace pleinair::measure
