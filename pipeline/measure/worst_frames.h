#pragma once

#include <cstdint>
#include <vector>

#include <opencv2/core.hpp>

#include "pipeline/measure/report/report.h"

namespace pleinair::measure {

/// Keeps the few frames of a sequence that read the worst, some way apart from each other.
class WorstFrames {
 public:
  void offer(std::uint64_t frame, double ew2, const cv::Mat3f& input, const cv::Mat3f& output,
             const cv::Mat3f& difference);
  /// The worst first.
  std::vector<WorstFrame> frames() const { return frames_; }

 private:
  std::vector<WorstFrame> frames_;
};

}  // namespace pleinair::measure
