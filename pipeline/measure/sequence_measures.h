#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <span>

#include "hal/error.h"
#include "pipeline/measure/anchor_measures.h"
#include "pipeline/measure/flatness.h"
#include "pipeline/measure/input/model_motion.h"
#include "pipeline/measure/input/true_motion.h"
#include "pipeline/measure/mean.h"
#include "pipeline/measure/model_anchors.h"
#include "pipeline/measure/model_regions.h"
#include "pipeline/measure/negative_controls.h"
#include "pipeline/measure/output_measures.h"

namespace pleinair::measure {

/// xFLK: flicker of a painting and its controls on a still scene under sensor noise.
class StillMeasures {
 public:
  explicit StillMeasures(cv::Size frame) : controls_(frame) {}

  /// Takes the next frame, of the constructor's size, RGB in [0, 1]. Where `ignored` (255), if
  /// given, was or is set, nothing counts.
  void add(const cv::Mat3f& input, const cv::Mat3f& output, const cv::Mat1b* ignored = nullptr);
  /// Flicker of a subject relative to the input's. Nothing for fewer than two frames or without
  /// noise.
  std::optional<double> flicker(Subject subject) const;

 private:
  ControlPainter controls_;
  PerSubject<cv::Mat3f> last_;
  cv::Mat1b lastIgnored_;
  PerSubject<Mean> flickers_;
  std::uint64_t frames_ = 0;
};

/// Measures of a painted sequence and its controls, frame by frame.
class SequenceMeasures {
 public:
  /// `motion` is null if it is unknown. `models`, if the pictures show any: the motion with theirs,
  /// which may be known where `motion` is not. Both must outlive this object.
  SequenceMeasures(cv::Size frame, TrueMotion* motion, ModelMotion* models = nullptr);

  /// Takes the next frame, and the anchors of its marks if it has any. `index` counts the input's
  /// frames and rises by one. Precondition: `models` has the frame. Errors: those of the motion's
  /// files.
  hal::Result<void> add(std::uint64_t index, const cv::Mat3f& input, const cv::Mat3f& output,
                        std::span<const marks::Anchor> anchors);

  const OutputMeasures& of(Subject subject) const { return outputs_[subject]; }
  const AnchorMeasures& anchors() const { return anchors_; }
  const ModelRegions& regions() const { return regions_; }
  const ModelAnchors& anchorsOnModels() const { return anchorsOnModels_; }
  std::optional<Flatness> flatness() const { return flatness_.total(); }
  /// All measures but xFLK.
  PerSubject<Measures> totals() const;
  /// EW2 of the input displaced by 2 px against its motion, over its own: a negative control.
  /// Nothing where its motion is not known.
  std::optional<double> displacedXEw2() const;
  MotionKind motionKind() const;
  /// The motion from the frame two before to the last one; null if it is not known.
  const MotionMap* lastMotion() const { return lastMotion_ ? &*lastMotion_ : nullptr; }

 private:
  /// Nothing if there is no motion, or no such frame was measured.
  hal::Result<std::optional<MotionMap>> motionOver(TrueMotion* motion, std::uint64_t index,
                                                   std::size_t lag) const;
  void compareDisplaced(const cv::Mat3f& input, const MotionMap* motion);
  hal::Result<void> addModels(std::uint64_t index, const PerSubject<cv::Mat3f>& pictures,
                              const MotionFromPast& toHere);
  void addAnchorsOnModels(std::uint64_t index, std::span<const marks::Anchor> anchors);

  TrueMotion* motion_;
  ModelMotion* models_;
  ControlPainter controls_;
  PerSubject<OutputMeasures> outputs_;
  AnchorMeasures anchors_;
  FlatnessMeasures flatness_;
  ModelRegions regions_;
  ModelAnchors anchorsOnModels_;
  std::deque<cv::Mat3f> inputs_;  ///< three at most, the newest last
  Mean followed_, displaced_;     ///< errors of the input
  std::optional<MotionMap> lastMotion_;
  std::size_t frames_ = 0;
};

}  // namespace pleinair::measure
