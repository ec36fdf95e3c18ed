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

constexpr int kRestFrames = 5;  // frames at rest after which a cell counts as static
/// A cell has moved when its smoothed shift exceeds this and also this many of its errors, or when
/// the shift in one frame is more than twice as large.
constexpr double kMovedPx = 0.1;
constexpr double kMovedErrors = 6.5;
constexpr double kSmoothing = 0.3;  // weight of one frame in the smoothed shift
/// A cell whose smoothed shift has a larger error has too little texture to decide. A cell that is
/// static already may have an error larger by the factor below.
constexpr double kMostErrorPx = 0.08;
constexpr double kStillMargin = 1.3;
constexpr double kLeastErrorPx = 0.01;
/// A cell has changed otherwise when its pixels vary this many times more than their noise.
constexpr double kChanged = 2.0;
constexpr double kLeastVariance = 0.5;  // levels²; rounding alone gives a twelfth, twice
constexpr double kSurelyNoticed = 4.0;  // times the smallest noticeable shift
constexpr double kAlongPx = 0.3;    // image motion in one frame at which a changed cell waits …
constexpr int kWaitFrames = 3;      // … for this many frames before it is compared again
constexpr double kMostUsual = 1.5;  // limit of a noisier cell's own noise, relative to the image's
constexpr double kNoisePace = 0.1;  // weight of one frame in the reported noise
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

/// Corner of the compared block of a cell; a cell may be a little wider than its block.
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

/// Whether a cell must not count as static yet although no motion was seen in it: the image moves,
/// and the cell may move with it by too little to be noticed.
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
  // Textured and bright pixels may be noisier than most: learn their variance while the cell comes
  // to rest.
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
  constexpr double kFlatPart = 0.15;  // part of the cells with so little texture that it is noise
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
    // Cells that move with the image are compared in turns, not in every frame.
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
