#pragma once

#include <cstdint>
#include <deque>

#include "hal/error.h"
#include "pipeline/measure/controls.h"
#include "pipeline/measure/output_measures.h"
#include "pipeline/measure/true_motion.h"

namespace pleinair::measure {

/// What a painted sequence and its controls read, while the frames go by.
class SequenceMeasures {
 public:
  /// `motion` is null where it is not known; else it outlives this.
  SequenceMeasures(cv::Size frame, TrueMotion* motion);

  /// The next frame. `index` counts the input's frames and rises by one. Errors: of the motion's
  /// files.
  hal::Result<void> add(std::uint64_t index, const cv::Mat3f& input, const cv::Mat3f& output);

  const OutputMeasures& of(Subject subject) const { return outputs_[subject]; }
  /// All but xFLK.
  PerSubject<Measures> totals() const;
  MotionKind motionKind() const;

 private:
  hal::Result<MotionMap> motionOver(std::uint64_t index, std::size_t lag) const;

  TrueMotion* motion_;
  ControlPainter controls_;
  PerSubject<OutputMeasures> outputs_;
  std::size_t frames_ = 0;
};

}  // namespace pleinair::measure
