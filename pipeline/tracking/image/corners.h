#pragma once

#include <cstddef>
#include <vector>

#include <opencv2/core.hpp>

#include "pipeline/tracking/image/luma_pyramid.h"

namespace pleinair::tracking {

/// Finds corners (Shi and Tomasi, "Good Features to Track", 1994), one image region at a time, in
/// an image of half the pyramid's size. One thread at a time.
class CornerSearch {
 public:
  /// Computes the corner strength of an image. Returns false when the image is too small to search.
  bool load(const LumaPyramid& pyramid);
  /// Size of the searched image: half of the pyramid's first level.
  cv::Size size() const { return strength_.size(); }
  /// Finds the strongest corner in a region of the searched image. `best` is in px of the pyramid's
  /// first level. The corner and its surroundings are not found again. Returns false if the region
  /// has none.
  bool takeStrongest(const cv::Rect& part, cv::Point2f& best);

  /// Between corners, in px of the pyramid's first level.
  static constexpr double kSpacingPx = 9.0;

 private:
  cv::Mat strength_;
};

/// Follows points from one image into another by pyramidal Lucas-Kanade (Bouguet, 2000), and back
/// again as a check (Kalal et al., "Forward-backward error", 2010). In px of the pyramids. One
/// thread at a time.
class PointFollower {
 public:
  /// On entry `points` holds one guess per origin of its position in `to`; on return it holds the
  /// positions found. The entry of a point that was not found is meaningless. Precondition: both
  /// pyramids have one size. A guess must be good to about 8 px of the smallest of the `levels`
  /// halved images that are used.
  void follow(const LumaPyramid& from, const LumaPyramid& to,
              const std::vector<cv::Point2f>& origins, std::vector<cv::Point2f>& points,
              int levels = LumaPyramid::kLevels);

  bool isFound(std::size_t i) const { return found_[i] != 0 && foundBack_[i] != 0; }
  /// Mean absolute difference of a point's two windows, in grey levels.
  double difference(std::size_t i) const { return static_cast<double>(differences_[i]); }
  /// Forward-backward error: the distance from a point's origin to where it was followed back.
  double forwardBackwardPx(std::size_t i) const { return forwardBackwardPx_[i]; }

 private:
  std::vector<unsigned char> found_;
  std::vector<unsigned char> foundBack_;
  std::vector<float> differences_;
  std::vector<float> unused_;
  std::vector<cv::Point2f> back_;
  std::vector<double> forwardBackwardPx_;
};

}  // namespace pleinair::tracking
