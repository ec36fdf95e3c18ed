#pragma once

#include <cstdint>
#include <vector>

#include <opencv2/core.hpp>

#include "pipeline/measure/measurement_report.h"

namespace pleinair::measure {

/// Keeps the few worst frames of a sequence, some distance apart from each other.
class WorstFrames {
 public:
  void offer(std::uint64_t frame, double ew2, const cv::Mat3f& input, const cv::Mat3f& output,
             const cv::Mat3f& difference);
  /// Worst first.
  std::vector<WorstFrame> frames() const { return frames_; }

 private:
  std::vector<WorstFrame> frames_;
};

}  // namespace pleinair::measure
