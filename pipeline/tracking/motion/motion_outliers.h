#pragma once

#include <span>
#include <vector>

#include <opencv2/core.hpp>

namespace pleinair::tracking {

/// Finds features that were confused with others: all their neighbours move differently. Where
/// objects overlap, each feature has neighbours on its own object. One thread at a time.
class MotionOutliers {
 public:
  /// Takes the positions of features and their motions, one per position; px of the followed image.
  /// Finds no outliers where there are too few features to judge.
  void judge(std::span<const cv::Point2f> places, std::span<const cv::Point2f> steps);
  bool isOutlier(std::size_t i) const { return isOutlier_[i] != 0; }

 private:
  std::vector<unsigned char> isOutlier_;
};

}  // namespace pleinair::tracking
