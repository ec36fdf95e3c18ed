#include "pipeline/tracking/motion/cut_detector.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <functional>
#include <numeric>
#include <tuple>
#include <utility>

#include <opencv2/imgproc.hpp>

#include "hal/median.h"
#include "pipeline/tracking/image/luma_pyramid.h"

namespace pleinair::tracking {

void Thumbnail::load(const LumaPyramid& pyramid) {
  const cv::Mat& level = pyramid.smallest(
      [](cv::Size size) { return size.width >= kWidth && size.height >= kHeight; });
  cv::Mat small;
  cv::resize(level, small, {kWidth, kHeight}, 0.0, 0.0, cv::INTER_AREA);
  cv::Mat target(kHeight, kWidth, CV_32F, values_.data());
  small.convertTo(target, CV_32F);
}

double Thumbnail::mean() const {
  const double sum = std::accumulate(values_.begin(), values_.end(), 0.0);
  return sum / static_cast<double>(values_.size());
}

double Thumbnail::unchangedPart(const Thumbnail& other) const {
  constexpr float kChanged = 2.5F;  // grey levels
  constexpr float kBlack = 10.0F;
  std::array<float, std::tuple_size_v<decltype(values_)>> differences{};
  std::ranges::transform(other.values_, values_, differences.begin(), std::minus<>{});
  constexpr float kMostLight = 20.0F;  // a bare view of another colour is another view
  const float light = hal::medianOf(differences);
  if (std::abs(light) > kMostLight) return 0.0;
  std::size_t unchanged = 0;
  for (std::size_t i = 0; i < values_.size(); ++i) {
    const bool isSeen = values_[i] > kBlack && other.values_[i] > kBlack;
    unchanged += isSeen && std::abs(other.values_[i] - values_[i] - light) < kChanged ? 1U : 0U;
  }
  return static_cast<double>(unchanged) / static_cast<double>(values_.size());
}

double Thumbnail::contrast() const {
  double sum = 0.0;
  double squares = 0.0;
  for (const float value : values_) {
    sum += static_cast<double>(value);
    squares += static_cast<double>(value) * static_cast<double>(value);
  }
  const double mean = sum / static_cast<double>(values_.size());
  return std::sqrt(std::max(0.0, squares / static_cast<double>(values_.size()) - mean * mean));
}

double Thumbnail::correlation(const Thumbnail& other, int dx, int dy) const {
  double a = 0.0;
  double b = 0.0;
  double aa = 0.0;
  double ab = 0.0;
  double bb = 0.0;
  const double count = static_cast<double>(kWidth - std::abs(dx)) * (kHeight - std::abs(dy));
  for (int y = std::max(0, -dy); y < std::min(kHeight, kHeight - dy); ++y) {
    for (int x = std::max(0, -dx); x < std::min(kWidth, kWidth - dx); ++x) {
      const auto p = static_cast<double>(at(x, y));
      const auto q = static_cast<double>(other.at(x + dx, y + dy));
      a += p;
      b += q;
      aa += p * p;
      ab += p * q;
      bb += q * q;
    }
  }
  const double spread = (aa - a * a / count) * (bb - b * b / count);
  constexpr double kMinSpread = 1e-6;
  return spread > kMinSpread ? (ab - a * b / count) / std::sqrt(spread) : 0.0;
}

Thumbnail::Match Thumbnail::match(const Thumbnail& other) const {
  Match best{.shift = glm::dvec2(0.0), .correlation = correlation(other, 0, 0)};
  for (int dy = -kHeight / 4; dy <= kHeight / 4; ++dy) {
    for (int dx = -kWidth / 4; dx <= kWidth / 4; ++dx) {
      const double found = correlation(other, dx, dy);
      if (!(found > best.correlation)) continue;
      best = {.shift = {static_cast<double>(dx) / kWidth, static_cast<double>(dy) / kHeight},
              .correlation = found};
    }
  }
  return best;
}

namespace {

/// Part of the features found at which the view is the same, and at which it is if the thumbnails
/// match as well: blocks of repeated or hardly any texture match at random places.
constexpr double kFollowedShare = 0.9;
constexpr double kHalfFollowedShare = 0.5;
constexpr double kSameThumbnail = 0.95;
constexpr double kSharedPart = 0.28;   // of the blocks with texture, in the same view
constexpr std::size_t kMinBlocks = 6;  // with texture; views with fewer are compared by thumbnails
constexpr std::size_t kMaxBlankBlocks = 2;  // with texture, of a blank frame
constexpr double kLostShare = 0.15;   // part of the features found; less means that they are lost
constexpr double kSameScene = 0.8;    // correlation of thumbnails
constexpr double kMinContrast = 4.0;  // standard deviation of a thumbnail, grey levels
constexpr double kMinMean = 16.0;     // grey levels of a bare wall: less may be a covered lens
constexpr double kUnchangedPart = 0.6;
constexpr int kMaxBlankFrames = 12;  // blank frames after which the earlier scene is given up

bool isBare(const Thumbnail& thumbnail) {
  return thumbnail.contrast() < kMinContrast;
}

}  // namespace

/// Compares in both directions: an occluder hides blocks of the earlier frame and brings blocks of
/// its own into the later one.
CutDetector::Likeness CutDetector::compare(double foundShare, double noise) {
  const auto there = comparison_.compare(seen_.view, current_.view, noise);
  if (there.textured >= kMinBlocks && there.sharedPart >= kSharedPart) return Likeness::kSameView;
  const auto back = comparison_.compare(current_.view, seen_.view, noise);
  if (back.textured >= kMinBlocks && back.sharedPart >= kSharedPart) return Likeness::kSameView;
  const bool isLost = foundShare < kLostShare;
  if (back.textured <= kMaxBlankBlocks && isLost && isBare(current_.thumbnail)) {
    const bool isWall = isBare(seen_.thumbnail) && seen_.thumbnail.mean() > kMinMean &&
                        current_.thumbnail.mean() > kMinMean;
    return isWall ? Likeness::kSameView : Likeness::kBlank;
  }
  const bool canCompare = there.textured >= kMinBlocks && back.textured >= kMinBlocks;
  if (!canCompare && !isLost) return Likeness::kSameView;
  // Somebody who comes before a bare wall brings all of the texture.
  const bool isSameWall =
      !canCompare && seen_.thumbnail.unchangedPart(current_.thumbnail) >= kUnchangedPart;
  if (isSameWall) return Likeness::kSameView;
  if (canCompare && foundShare < kHalfFollowedShare) return Likeness::kOtherView;
  const double correlation = seen_.thumbnail.match(current_.thumbnail).correlation;
  return correlation < (canCompare ? kSameThumbnail : kSameScene) ? Likeness::kOtherView
                                                                  : Likeness::kSameView;
}

bool CutDetector::isCut(const LumaPyramid& current, double foundShare, double noise) {
  current_.thumbnail.load(current);
  current_.view.load(current);
  Likeness likeness = Likeness::kOtherView;
  if (hasSeen_) {
    likeness = foundShare < kFollowedShare ? compare(foundShare, noise) : Likeness::kSameView;
  }
  bool isCut = likeness == Likeness::kOtherView;
  if (likeness == Likeness::kBlank) {
    isCut = ++blankFrames_ == kMaxBlankFrames && seen_.thumbnail.contrast() >= kMinContrast;
    if (!isCut) return false;
  } else {
    blankFrames_ = 0;
  }
  hasSeen_ = true;
  std::swap(seen_, current_);
  return isCut;
}

}  // namespace pleinair::tracking
