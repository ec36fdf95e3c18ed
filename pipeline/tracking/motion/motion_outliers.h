#pragma once

#include <span>
#include <vector>

#include <opencv2/core.hpp>

namespace pleinair::tracking {

/// Tells features that were mistaken for others: all their neighbours move otherwise. Where things
/// overlap each has neighbours on its own. One thread at a time.
class MotionOutliers {
 public:
  /// Places of features and how they have moved, as many; px of the picture that is followed. None
  /// where there are too few to judge.
  void judge(std::span<const cv::Point2f> places, std::span<const cv::Point2f> steps);
  bool isOutlier(std::size_t i) const { return isOutlier_[i] != 0; }

 private:
  std::vector<unsigned char> isOutlier_;
};

}  // namespace pleinair::tracking
