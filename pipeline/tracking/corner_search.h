#pragma once

#include <opencv2/core.hpp>

#include "pipeline/tracking/luma_pyramid.h"

namespace pleinair::tracking {

/// Finds corners (Shi and Tomasi, "Good Features to Track", 1994) part by part, in a picture of
/// half the pyramid's size. One thread at a time.
class CornerSearch {
 public:
  /// Looks at a picture. Whether it is large enough to be searched.
  bool look(const LumaPyramid& pyramid);
  /// Of what is searched: half the pyramid's.
  cv::Size size() const { return strength_.size(); }
  /// The best corner within a part of what is searched, in the pyramid's px; it and what is near
  /// are not found again. False where there is none.
  bool takeBest(const cv::Rect& part, cv::Point2f& best);

  static constexpr double kSpacingPx = 9.0;  ///< between corners, of the pyramid's picture

 private:
  cv::Mat strength_;
};

}  // namespace pleinair::tracking
