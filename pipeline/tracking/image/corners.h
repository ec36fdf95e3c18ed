#pragma once

#include <cstddef>
#include <vector>

#include <opencv2/core.hpp>

#include "pipeline/tracking/image/luma_pyramid.h"

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

/// Follows points from one picture into another by pyramidal Lucas-Kanade (Bouguet, 2000), and
/// from there back to where they should have come from (Kalal et al., "Forward-backward error",
/// 2010). In the pyramids' px. One thread at a time.
class PointFollower {
 public:
  /// `points` holds guesses of where `origins` are in `to`, as many, and what was found then: of
  /// those that are not, nothing that means something. Precondition: pyramids of one size.
  /// Guesses are good to some 8 px of the smallest of `levels` halved pictures that are used.
  void follow(const LumaPyramid& from, const LumaPyramid& to,
              const std::vector<cv::Point2f>& origins, std::vector<cv::Point2f>& points,
              int levels = LumaPyramid::kLevels);

  bool isFound(std::size_t i) const { return found_[i] != 0 && foundBack_[i] != 0; }
  /// Mean difference of a point's two windows, grey levels.
  double difference(std::size_t i) const { return static_cast<double>(differences_[i]); }
  /// How far from its origin it came back.
  double backPx(std::size_t i) const { return backPx_[i]; }

 private:
  std::vector<unsigned char> found_;
  std::vector<unsigned char> foundBack_;
  std::vector<float> differences_;
  std::vector<float> unused_;
  std::vector<cv::Point2f> back_;
  std::vector<double> backPx_;
};

}  // namespace pleinair::tracking
