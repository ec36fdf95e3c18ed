#include "pipeline/tracking/motion/harris_sift_tracker.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <opencv2/imgproc.hpp>

#include "pipeline/tracking/image/luma_pyramid.h"
#include "pipeline/tracking/motion/image_motion.h"

namespace pleinair::tracking {
namespace {

constexpr double kOfStrongest = 0.2;
constexpr double kHarris = 0.04;
constexpr int kWindowPx = 5;
constexpr double kMinStrength = 1e-7;  // a blank image's strongest corner is noise
constexpr float kSizePx = 4.0F;        // size of a feature; descriptors cover about 20 px around it
constexpr double kBorderPx = 8.0;
constexpr float kRatio = 0.8F;  // Lowe, "Distinctive image features", 2004
constexpr int kTrees = 4;
constexpr int kChecks = 32;
/// Predicted error: corners are detected anew in each frame. docs/measured.md compares it with the
/// true one.
constexpr double kErrorPx = 0.35;

/// Sub-pixel maximum of the strength around a pixel, by the parabola through its neighbours.
cv::Point2f peakWithin(const cv::Mat& strength, const cv::Point2f& pixel) {
  const cv::Point at = pixel;
  const auto offset = [](float before, float here, float after) {
    const float bend = before - 2.0F * here + after;
    return bend < 0.0F ? std::clamp(0.5F * (before - after) / bend, -0.5F, 0.5F) : 0.0F;
  };
  const auto here = strength.at<float>(at);
  return {offset(strength.at<float>(at.y, at.x - 1), here, strength.at<float>(at.y, at.x + 1)),
          offset(strength.at<float>(at.y - 1, at.x), here, strength.at<float>(at.y + 1, at.x))};
}

}  // namespace

HarrisSiftTracker::HarrisSiftTracker()
    : sift_(cv::SIFT::create()),
      matcher_(cv::makePtr<cv::flann::KDTreeIndexParams>(kTrees),
               cv::makePtr<cv::flann::SearchParams>(kChecks)) {}

void HarrisSiftTracker::reset() {
  previous_ = {};
  seen_.clear();
  foundShare_ = 0.0;
}

void HarrisSiftTracker::findCorners(const LumaPyramid& current) {
  current_.places.clear();
  keypoints_.clear();
  const cv::Mat& picture = current.picture();
  constexpr int kMinSidePx = 32;
  if (std::min(picture.cols, picture.rows) < kMinSidePx) return;
  cv::cornerHarris(picture, strength_, kWindowPx, 3, kHarris);
  double strongest = 0.0;
  cv::minMaxLoc(strength_, nullptr, &strongest);
  if (!(strongest > kMinStrength)) return;
  cv::dilate(strength_, strongestNear_, {});
  const auto least = static_cast<float>(kOfStrongest * strongest);
  for (int y = 0; y < picture.rows; ++y) {
    for (int x = 0; x < picture.cols; ++x) {
      const auto strength = strength_.at<float>(y, x);
      const cv::Point2f at(static_cast<float>(x), static_cast<float>(y));
      if (strength < least || strength < strongestNear_.at<float>(y, x)) continue;
      if (current.isInside(at, kBorderPx)) keypoints_.emplace_back(at, kSizePx, 0.0F, strength);
    }
  }
  std::ranges::stable_sort(keypoints_, std::ranges::greater{}, &cv::KeyPoint::response);
  if (keypoints_.size() > kMaxMovedFeatures) keypoints_.resize(kMaxMovedFeatures);
  for (const cv::KeyPoint& keypoint : keypoints_) {
    current_.places.push_back(keypoint.pt + peakWithin(strength_, keypoint.pt));
  }
}

void HarrisSiftTracker::describe(const LumaPyramid& current) {
  current_.descriptors.release();
  if (keypoints_.empty()) return;
  for (std::size_t i = 0; i < keypoints_.size(); ++i) keypoints_[i].pt = current_.places[i];
  const std::size_t count = keypoints_.size();
  sift_->compute(current.picture(), keypoints_, current_.descriptors);
  if (keypoints_.size() == count) return;
  current_.places.clear();  // some could not be described
  for (const cv::KeyPoint& keypoint : keypoints_) current_.places.push_back(keypoint.pt);
}

void HarrisSiftTracker::match() {
  matches_.clear();
  if (current_.descriptors.rows == 0 || previous_.descriptors.rows < 2) return;
  nearest_.clear();
  matcher_.knnMatch(current_.descriptors, previous_.descriptors, nearest_, 2);
  // If several features match the same one, the nearest descriptor wins.
  previousBest_.assign(previous_.places.size(), 1e18F);
  const auto passes = [](const std::vector<cv::DMatch>& two) {
    return two.size() == 2 && two[0].distance < kRatio * two[1].distance;
  };
  for (const auto& two : nearest_) {
    if (!passes(two)) continue;
    float& best = previousBest_[static_cast<std::size_t>(two[0].trainIdx)];
    best = std::min(best, two[0].distance);
  }
  places_.clear();
  steps_.clear();
  for (const auto& two : nearest_) {
    if (!passes(two)) continue;
    const auto current = static_cast<std::size_t>(two[0].queryIdx);
    const auto previous = static_cast<std::size_t>(two[0].trainIdx);
    if (two[0].distance > previousBest_[previous]) continue;
    previousBest_[previous] = -1.0F;  // each is matched once
    matches_.push_back({.current = two[0].queryIdx, .previous = two[0].trainIdx});
    places_.push_back(current_.places[current]);
    steps_.push_back(current_.places[current] - previous_.places[previous]);
  }
  outliers_.judge(places_, steps_);
}

void HarrisSiftTracker::publish(const LumaPyramid& current) {
  seen_.clear();
  current_.ids.assign(current_.places.size(), 0);
  std::vector<bool> isKnown(current_.places.size(), false);
  const double scale = std::max(current.reduction().x, current.reduction().y);
  for (std::size_t m = 0; m < matches_.size(); ++m) {
    if (outliers_.isOutlier(m)) continue;
    const auto at = static_cast<std::size_t>(matches_[m].current);
    const auto previous = static_cast<std::size_t>(matches_[m].previous);
    current_.ids[at] = previous_.ids[previous];
    isKnown[at] = true;
    seen_.push_back({.id = current_.ids[at],
                     .px = current.framePx(current_.places[at]),
                     .errorPx = kErrorPx * scale,
                     .wasSeen = true,
                     .previousPx = current.framePx(previous_.places[previous])});
  }
  for (std::size_t i = 0; i < isKnown.size(); ++i) {
    if (!isKnown[i]) current_.ids[i] = nextId_++;
  }
  std::ranges::sort(seen_, {}, &SeenFeature::id);
}

std::span<const SeenFeature> HarrisSiftTracker::follow(std::shared_ptr<const LumaPyramid> current,
                                                       double /*noise*/) {
  if (frameSize_ != current->frameSize()) reset();
  frameSize_ = current->frameSize();
  findCorners(*current);
  describe(*current);
  match();
  publish(*current);
  foundShare_ = previous_.places.empty() ? 0.0
                                         : static_cast<double>(seen_.size()) /
                                               static_cast<double>(previous_.places.size());
  std::swap(previous_, current_);
  return seen_;
}

}  // namespace pleinair::tracking
