#include "pipeline/tracking/image/corners.h"

#include <cmath>

#include <opencv2/imgproc.hpp>
#include <opencv2/video/tracking.hpp>

namespace pleinair::tracking {
namespace {

/// Smallest accepted eigenvalue of a window's gradient matrix, in OpenCV's scale: about 1.3 grey
/// levels per pixel.
constexpr float kMinCornerStrength = 1e-4F;

}  // namespace

bool CornerSearch::load(const LumaPyramid& pyramid) {
  constexpr std::size_t kSecondLevel = 2;  // each level is followed by its gradients
  if (pyramid.levels().size() <= kSecondLevel) {
    strength_.release();
    return false;
  }
  cv::cornerMinEigenVal(pyramid.levels()[kSecondLevel], strength_, 5);
  return true;
}

bool CornerSearch::takeStrongest(const cv::Rect& part, cv::Point2f& best) {
  const cv::Rect inside = part & cv::Rect({}, strength_.size());
  if (inside.empty()) return false;
  double strength = 0.0;
  cv::Point at;
  cv::minMaxLoc(strength_(inside), nullptr, &strength, nullptr, &at);
  if (!(strength > static_cast<double>(kMinCornerStrength))) return false;
  at += inside.tl();
  const int reach = static_cast<int>(kSpacingPx / 2.0);
  const cv::Rect around(at.x - reach, at.y - reach, 2 * reach + 1, 2 * reach + 1);
  strength_(around & cv::Rect({}, strength_.size())).setTo(0.0F);
  best = {2.0F * static_cast<float>(at.x), 2.0F * static_cast<float>(at.y)};
  return true;
}

void PointFollower::follow(const LumaPyramid& from, const LumaPyramid& to,
                           const std::vector<cv::Point2f>& origins,
                           std::vector<cv::Point2f>& points, int levels) {
  forwardBackwardPx_.clear();
  if (origins.empty()) return;
  const cv::Size window(LumaPyramid::kWindowPx, LumaPyramid::kWindowPx);
  const cv::TermCriteria until(cv::TermCriteria::COUNT | cv::TermCriteria::EPS, 20, 0.005);
  cv::calcOpticalFlowPyrLK(from.levels(), to.levels(), origins, points, found_, differences_,
                           window, levels, until, cv::OPTFLOW_USE_INITIAL_FLOW, 1e-3);
  back_ = origins;
  const cv::TermCriteria briefly(cv::TermCriteria::COUNT | cv::TermCriteria::EPS, 5, 0.05);
  cv::calcOpticalFlowPyrLK(to.levels(), from.levels(), points, back_, foundBack_, unused_, window,
                           0, briefly, cv::OPTFLOW_USE_INITIAL_FLOW, 1e-3);
  for (std::size_t i = 0; i < origins.size(); ++i) {
    const cv::Point2f apart = back_[i] - origins[i];
    forwardBackwardPx_.push_back(std::sqrt(static_cast<double>(apart.dot(apart))));
  }
}

}  // namespace pleinair::tracking
