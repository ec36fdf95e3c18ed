#include "pipeline/tracking/motion/cut_detector.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include <opencv2/imgproc.hpp>

#include "pipeline/tracking/image/luma_pyramid.h"

namespace pleinair::tracking {

void Thumbnail::load(const LumaPyramid& pyramid) {
  // Uses the smallest level that is not smaller than a thumbnail. Each level is followed by its
  // gradients.
  const auto& levels = pyramid.levels();
  std::size_t level = 0;
  while (level + 2 < levels.size() && levels[level + 2].cols >= kWidth &&
         levels[level + 2].rows >= kHeight) {
    level += 2;
  }
  cv::Mat small;
  cv::resize(levels[level], small, {kWidth, kHeight}, 0.0, 0.0, cv::INTER_AREA);
  cv::Mat target(kHeight, kWidth, CV_32F, values_.data());
  small.convertTo(target, CV_32F);
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

constexpr double kLostShare = 0.15;   // part of the features found; less means that they are lost
constexpr double kSameScene = 0.8;    // correlation of thumbnails
constexpr double kMinContrast = 4.0;  // standard deviation of a thumbnail, grey levels
constexpr int kMaxBlankFrames = 12;   // blank frames after which the earlier scene is given up

}  // namespace

bool CutDetector::isCut(const LumaPyramid& current, double foundShare) {
  current_.load(current);
  if (!seen_) {
    seen_ = current_;
    blankFrames_ = 0;
    return true;
  }
  if (foundShare < kLostShare && current_.contrast() < kMinContrast) {
    const bool isCut = ++blankFrames_ == kMaxBlankFrames && seen_->contrast() >= kMinContrast;
    if (isCut) seen_ = current_;
    return isCut;
  }
  blankFrames_ = 0;
  const bool isCut = foundShare < kLostShare && seen_->match(current_).correlation < kSameScene;
  seen_ = current_;
  return isCut;
}

}  // namespace pleinair::tracking
