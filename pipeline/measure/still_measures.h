#pragma once

#include <cstdint>

#include "pipeline/measure/controls.h"
#include "pipeline/measure/mean.h"

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

}  // namespace pleinair::measure
