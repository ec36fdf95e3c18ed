#include "pipeline/tracking/motion/static_regions.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include "pipeline/tracking/image/homography.h"
#include "pipeline/tracking/image/luma_pyramid.h"
#include "pipeline/tracking/image/parallel_loop.h"

namespace pleinair::tracking {
namespace {

constexpr int kRestFrames = 5;  // after which a field counts as still
/// A field has moved when the smoothed shift is more than this, and than so many of its errors;
/// or that of a single frame is more than twice as much.
constexpr double kMovedPx = 0.1;
constexpr double kMovedErrors = 6.5;
constexpr double kSmoothing = 0.3;  // the part of a frame in the smoothed shift
/// Larger errors of the smoothed shift: too little texture to tell. By so much more for those that
/// are still already.
constexpr double kMostErrorPx = 0.08;
constexpr double kStillMargin = 1.3;
constexpr double kLeastErrorPx = 0.01;
/// It has changed otherwise when its pixels vary by so many times more than their noise.
constexpr double kChanged = 2.0;
constexpr double kLeastVariance = 0.5;  // levels²; rounding alone is a twelfth, twice
constexpr double kSurelyNoticed = 4.0;  // times what is noticed
constexpr double kAlongPx = 0.3;        // of a frame's motion, with which a field waits …
constexpr int kWaitFrames = 3;          // … so long before it is looked at again
constexpr double kMostUsual = 1.5;      // times the picture's noise, of a noisier field's
constexpr double kNoisePace = 0.1;      // the part of a frame in the noise that is told
constexpr std::size_t kLeastFields = 24;

}  // namespace

void StaticRegionDetector::reset() {
  size_ = {};
  knowsNoise_ = false;
}

void StaticRegionDetector::resize(const LumaPyramid& now) {
  const cv::Size size = now.picture().size();
  if (size == size_) return;
  size_ = size;
  grid_ = {size.width / StaticBlock::kSide, size.height / StaticBlock::kSide};
  if (grid_.pixels() == 0) grid_ = {};
  const auto count = static_cast<std::size_t>(grid_.pixels());
  rests_.assign(count, {});
  errors_.assign(count, StaticRegions::kNotStatic);
  variances_.reserve(count);
}

/// Of the part of a field that is looked at: a field may be a little wider.
cv::Point StaticRegionDetector::corner(std::size_t index, const cv::Size& size) const {
  const auto middle = [](int i, int count, int side) {
    const int at = (2 * i + 1) * side / (2 * count) - StaticBlock::kSide / 2;
    return std::clamp(at, 0, side - StaticBlock::kSide);
  };
  const int i = static_cast<int>(index);
  return {middle(i % grid_.width, grid_.width, size.width),
          middle(i / grid_.width, grid_.height, size.height)};
}

void StaticRegionDetector::restart(Rest& rest, const cv::Mat& picture, const cv::Point& corner) {
  rest.field.restart(picture, corner);
  rest.movedPx = glm::dvec2(0.0);
  rest.frames = 0;
  rest.isStill = false;
  rest.alongPx = glm::dvec2(0.0);
  rest.variance = 0.0;
  rest.hasBegun = true;
  const cv::Rect inner(1, 1, picture.cols - 2, picture.rows - 2);
  const cv::Rect window(corner, cv::Size(StaticBlock::kSide, StaticBlock::kSide));
  if ((inner & window) == window) {
    const double noise = spatialNoise(picture, corner, StaticBlock::kSide);
    rest.spatial = noise * noise;
  }
}

/// Whether a field that has not been seen to move can be taken for still although the picture
/// moves: not when it may go along with it and that would not have been seen yet.
bool StaticRegionDetector::isDoubtful(const Rest& rest, double noticedPx) {
  const double along = glm::length(rest.alongPx);
  return along > kMovedPx && along < kSurelyNoticed * noticedPx;
}

float StaticRegionDetector::look(Rest& rest, const cv::Mat& picture, const cv::Point& corner,
                                 double scale) {
  rest.hasChanged = false;
  if (rest.waitFrames > 0) {
    --rest.waitFrames;
    return StaticRegions::kNotStatic;
  }
  if (!rest.hasBegun) {
    restart(rest, picture, corner);
    return StaticRegions::kNotStatic;
  }
  const StaticBlock::Change change = rest.field.compare(picture, corner);
  const double ofReference = 1.0 / rest.field.frames();
  const double once = noise_ * change.placing * std::sqrt(1.0 + ofReference);
  const double smoothed =
      noise_ * change.placing * std::sqrt(kSmoothing / (2.0 - kSmoothing) + ofReference);
  rest.movedPx += kSmoothing * (change.movedPx - rest.movedPx);
  const double moved = glm::length(rest.movedPx);
  const double variance = change.variance / (1.0 + ofReference);
  const double noise = std::max(noise_ * noise_, kLeastVariance);
  const double usual = std::clamp(rest.variance, noise, kMostUsual * noise);
  const double noticed = std::max(kMovedPx, kMovedErrors * smoothed);
  if (moved > noticed ||
      glm::length(change.movedPx) > std::max(2.0 * kMovedPx, kMovedErrors * once) ||
      variance > kChanged * usual) {
    rest.hasChanged = true;
    restart(rest, picture, corner);
    return StaticRegions::kNotStatic;
  }
  rest.temporal = variance;
  ++rest.frames;
  if (rest.field.frames() < StaticBlock::kReferenceFrames) rest.field.add(picture, corner);
  // Textured and bright pixels may be noisier than most; what they vary by while it comes to rest.
  if (rest.frames < kRestFrames) rest.variance = std::max(rest.variance, variance);
  const double most = rest.isStill ? kStillMargin * kMostErrorPx : kMostErrorPx;
  rest.isStill = rest.frames >= kRestFrames && smoothed < most;
  if (!rest.isStill || isDoubtful(rest, noticed)) return StaticRegions::kNotStatic;
  return static_cast<float>(scale * glm::length(glm::dvec3(smoothed, moved, kLeastErrorPx)));
}

std::optional<double> StaticRegionDetector::percentile(double Rest::*of, double part) {
  variances_.clear();
  for (const Rest& rest : rests_) {
    if (rest.*of >= 0.0) variances_.push_back(rest.*of);
  }
  if (variances_.size() < kLeastFields) return std::nullopt;
  const auto at = static_cast<std::ptrdiff_t>(part * static_cast<double>(variances_.size() - 1));
  std::nth_element(variances_.begin(), variances_.begin() + at, variances_.end());
  return variances_[static_cast<std::size_t>(at)];
}

void StaticRegionDetector::measureNoise() {
  constexpr double kFlatPart = 0.15;  // of fields that have so little texture that it is noise
  auto variance = percentile(&Rest::temporal, 0.5);
  if (!variance) variance = percentile(&Rest::spatial, kFlatPart);
  if (!variance) return;
  const double now = std::sqrt(*variance);
  noise_ = knowsNoise_ ? noise_ + kNoisePace * (now - noise_) : now;
  knowsNoise_ = true;
}

void StaticRegionDetector::update(const LumaPyramid& now,
                                  const std::optional<PictureHomography>& picture) {
  resize(now);
  const double scale = std::max(now.reduction().x, now.reduction().y);
  const auto count = static_cast<int>(rests_.size());
  parallelFor(count, [&](int i) {
    const auto index = static_cast<std::size_t>(i);
    Rest& rest = rests_[index];
    const cv::Point at = corner(index, size_);
    glm::dvec2 along(0.0);
    if (picture) {
      constexpr float kMiddle = StaticBlock::kSide / 2.0F - 0.5F;
      const glm::dvec2 px = now.framePx(cv::Point2f(at) + cv::Point2f(kMiddle, kMiddle));
      along = (movedBy(picture->nowFromThen, px) - px) / now.reduction();
    }
    rest.alongPx += along;
    rest.temporal = rest.spatial = -1.0;
    errors_[index] = look(rest, now.picture(), at, scale);
    // What goes along with a picture that moves is not looked at each time, nor all at once.
    if (rest.hasChanged && glm::length(along) > kAlongPx) {
      rest.waitFrames = kWaitFrames + i % kWaitFrames;
      rest.hasBegun = false;
    }
  });
  measureNoise();
}

float StaticRegionDetector::errorAt(const glm::dvec2& px, hal::FrameSize size) const {
  if (errors_.empty()) return StaticRegions::kNotStatic;
  const int column =
      std::clamp(static_cast<int>(px.x * grid_.width / size.width), 0, grid_.width - 1);
  const int row =
      std::clamp(static_cast<int>(px.y * grid_.height / size.height), 0, grid_.height - 1);
  return errors_[static_cast<std::size_t>(row * grid_.width + column)];
}

}  // namespace pleinair::tracking
