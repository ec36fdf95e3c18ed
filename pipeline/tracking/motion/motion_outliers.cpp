#include "pipeline/tracking/motion/motion_outliers.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <utility>

namespace pleinair::tracking {
namespace {

constexpr std::size_t kMinToJudge = 12;
constexpr std::size_t kNeighbours = 6;
/// Two motions are alike if they differ by no more than this, or than this part of them.
constexpr float kAlikePx = 1.5F;
constexpr float kAlikePart = 0.25F;

using Neighbours = std::array<std::pair<float, std::size_t>, kNeighbours>;

/// The nearest other features with their squared distances, nearest first.
Neighbours neighboursOf(std::size_t i, std::span<const cv::Point2f> places) {
  Neighbours near;
  near.fill({1e18F, i});
  for (std::size_t j = 0; j < places.size(); ++j) {
    if (j == i) continue;
    const cv::Point2f apart = places[j] - places[i];
    const float distance = apart.dot(apart);
    if (distance >= near.back().first) continue;
    near.back() = {distance, j};
    for (std::size_t k = kNeighbours - 1; k > 0 && near[k].first < near[k - 1].first; --k) {
      std::swap(near[k], near[k - 1]);
    }
  }
  return near;
}

}  // namespace

void MotionOutliers::judge(std::span<const cv::Point2f> places,
                           std::span<const cv::Point2f> steps) {
  assert(places.size() == steps.size());
  isOutlier_.assign(places.size(), 0);
  if (places.size() < kMinToJudge) return;
  for (std::size_t i = 0; i < places.size(); ++i) {
    const float tolerance =
        std::max(kAlikePx * kAlikePx, kAlikePart * kAlikePart * steps[i].dot(steps[i]));
    const Neighbours near = neighboursOf(i, places);
    const bool isAlone = std::ranges::none_of(near, [&](const auto& other) {
      const cv::Point2f apart = steps[other.second] - steps[i];
      return apart.dot(apart) < tolerance;
    });
    isOutlier_[i] = isAlone ? 1 : 0;
  }
}

}  // namespace pleinair::tracking
