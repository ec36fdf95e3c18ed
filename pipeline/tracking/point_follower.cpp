#include "pipeline/tracking/point_follower.h"

#include <cmath>

#include <opencv2/video/tracking.hpp>

namespace pleinair::tracking {

void PointFollower::follow(const LumaPyramid& from, const LumaPyramid& to,
                           const std::vector<cv::Point2f>& origins,
                           std::vector<cv::Point2f>& points, int levels) {
  backPx_.clear();
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
    backPx_.push_back(std::sqrt(static_cast<double>(apart.dot(apart))));
  }
}

}  // namespace pleinair::tracking
