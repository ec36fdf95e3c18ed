#include "pipeline/tracking/corner_search.h"

#include <opencv2/imgproc.hpp>

namespace pleinair::tracking {
namespace {

/// Least eigenvalue of the gradients in a window, OpenCV's measure: about 1.3 levels a pixel.
constexpr float kLeastCorner = 1e-4F;

}  // namespace

bool CornerSearch::look(const LumaPyramid& pyramid) {
  constexpr std::size_t kSecondLevel = 2;  // each level's gradients follow it
  if (pyramid.levels().size() <= kSecondLevel) {
    strength_.release();
    return false;
  }
  cv::cornerMinEigenVal(pyramid.levels()[kSecondLevel], strength_, 5);
  return true;
}

bool CornerSearch::takeBest(const cv::Rect& part, cv::Point2f& best) {
  const cv::Rect inside = part & cv::Rect({}, strength_.size());
  if (inside.empty()) return false;
  double strength = 0.0;
  cv::Point at;
  cv::minMaxLoc(strength_(inside), nullptr, &strength, nullptr, &at);
  if (!(strength > static_cast<double>(kLeastCorner))) return false;
  at += inside.tl();
  const int reach = static_cast<int>(kSpacingPx / 2.0);
  const cv::Rect around(at.x - reach, at.y - reach, 2 * reach + 1, 2 * reach + 1);
  strength_(around & cv::Rect({}, strength_.size())).setTo(0.0F);
  best = {2.0F * static_cast<float>(at.x), 2.0F * static_cast<float>(at.y)};
  return true;
}

}  // namespace pleinair::tracking
