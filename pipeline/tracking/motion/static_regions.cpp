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
constexpr double kMaxErrorPx = 0.08;
constexpr double kStaticMargin = 1.3;
constexpr double kMinErrorPx = 0.01;
/// A cell has changed otherwise when its pixels vary this many times more than their noise.
constexpr double kChanged = 2.0;
constexpr double kMinVariance = 0.5;       // levels²; rounding alone gives a twelfth, twice
constexpr double kSurelyNoticeable = 4.0;  // times the smallest noticeable shift
constexpr double kMovingImagePx = 0.3;  // image motion in one frame at which a changed cell waits …
constexpr int kWaitFrames = 3;          // … for this many frames before it is compared again
constexpr double kMaxOwnNoise =
    1.5;                            // limit of a noisier cell's own noise, relative to the image's
constexpr double kNoisePace = 0.1;  // weight of one frame in the reported noise
constexpr std::size_t kMinCells = 24;

}  // namespace

void StaticRegionDetector::reset() {
  size_ = {};
  noise_ = kUsualNoiseLevels;
  knowsNoise_ = false;
}

void StaticRegionDetector::resize(const LumaPyramid& current) {
  const cv::Size size = current.picture().size();
  if (size == size_) return;
  size_ = size;
  grid_ = {size.width / StaticBlock::kSide, size.height / StaticBlock::kSide};
  if (grid_.pixels() == 0) grid_ = {};
  const auto count = static_cast<std::size_t>(grid_.pixels());
  cells_.assign(count, {});
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

void StaticRegionDetector::restart(Cell& cell, const cv::Mat& picture, const cv::Point& corner) {
  cell.field.restart(picture, corner);
  cell.movedPx = glm::dvec2(0.0);
  cell.frames = 0;
  cell.isStatic = false;
  cell.imageMotionPx = glm::dvec2(0.0);
  cell.variance = 0.0;
  cell.hasBegun = true;
  const cv::Rect inner(1, 1, picture.cols - 2, picture.rows - 2);
  const cv::Rect window(corner, cv::Size(StaticBlock::kSide, StaticBlock::kSide));
  if ((inner & window) == window) {
    const double noise = spatialNoise(picture, corner, StaticBlock::kSide);
    cell.spatial = noise * noise;
  }
}

/// Whether a cell must not count as static yet although no motion was seen in it: the image moves,
/// and the cell may move with it by too little to be noticed.
bool StaticRegionDetector::isDoubtful(const Cell& cell, double noticedPx) {
  const double along = glm::length(cell.imageMotionPx);
  return along > kMovedPx && along < kSurelyNoticeable * noticedPx;
}

float StaticRegionDetector::assess(Cell& cell, const cv::Mat& picture, const cv::Point& corner,
                                   double scale) {
  cell.hasChanged = false;
  if (cell.waitFrames > 0) {
    --cell.waitFrames;
    return StaticRegions::kNotStatic;
  }
  if (!cell.hasBegun) {
    restart(cell, picture, corner);
    return StaticRegions::kNotStatic;
  }
  const StaticBlock::Change change = cell.field.compare(picture, corner);
  const double ofReference = 1.0 / cell.field.frames();
  const double once = noise_ * change.placing * std::sqrt(1.0 + ofReference);
  const double smoothed =
      noise_ * change.placing * std::sqrt(kSmoothing / (2.0 - kSmoothing) + ofReference);
  cell.movedPx += kSmoothing * (change.movedPx - cell.movedPx);
  const double moved = glm::length(cell.movedPx);
  const double variance = change.variance / (1.0 + ofReference);
  const double noise = std::max(noise_ * noise_, kMinVariance);
  const double usual = std::clamp(cell.variance, noise, kMaxOwnNoise * noise);
  const double noticed = std::max(kMovedPx, kMovedErrors * smoothed);
  if (moved > noticed ||
      glm::length(change.movedPx) > std::max(2.0 * kMovedPx, kMovedErrors * once) ||
      variance > kChanged * usual) {
    cell.hasChanged = true;
    restart(cell, picture, corner);
    return StaticRegions::kNotStatic;
  }
  cell.temporal = variance;
  ++cell.frames;
  if (cell.field.frames() < StaticBlock::kReferenceFrames) cell.field.add(picture, corner);
  // Textured and bright pixels may be noisier than maxErrorPx: learn their variance while the cell
  // comes to rest.
  if (cell.frames < kRestFrames) cell.variance = std::max(cell.variance, variance);
  const double maxErrorPx = cell.isStatic ? kStaticMargin * kMaxErrorPx : kMaxErrorPx;
  cell.isStatic = cell.frames >= kRestFrames && smoothed < maxErrorPx;
  if (!cell.isStatic || isDoubtful(cell, noticed)) return StaticRegions::kNotStatic;
  return static_cast<float>(scale * glm::length(glm::dvec3(smoothed, moved, kMinErrorPx)));
}

std::optional<double> StaticRegionDetector::percentile(double Cell::*of, double part) {
  variances_.clear();
  for (const Cell& cell : cells_) {
    if (cell.*of >= 0.0) variances_.push_back(cell.*of);
  }
  if (variances_.size() < kMinCells) return std::nullopt;
  const auto at = static_cast<std::ptrdiff_t>(part * static_cast<double>(variances_.size() - 1));
  std::nth_element(variances_.begin(), variances_.begin() + at, variances_.end());
  return variances_[static_cast<std::size_t>(at)];
}

void StaticRegionDetector::measureNoise() {
  constexpr double kFlatPart = 0.15;  // part of the cells with so little texture that it is noise
  auto variance = percentile(&Cell::temporal, 0.5);
  if (!variance) variance = percentile(&Cell::spatial, kFlatPart);
  if (!variance) return;
  const double current = std::sqrt(*variance);
  noise_ = knowsNoise_ ? noise_ + kNoisePace * (current - noise_) : current;
  knowsNoise_ = true;
}

void StaticRegionDetector::update(const LumaPyramid& current,
                                  const std::optional<ImageHomography>& picture) {
  resize(current);
  const double scale = std::max(current.reduction().x, current.reduction().y);
  const auto count = static_cast<int>(cells_.size());
  parallelFor(count, [&](int i) {
    const auto index = static_cast<std::size_t>(i);
    Cell& cell = cells_[index];
    const cv::Point at = corner(index, size_);
    glm::dvec2 along(0.0);
    if (picture) {
      constexpr float kMiddle = StaticBlock::kSide / 2.0F - 0.5F;
      const glm::dvec2 px = current.framePx(cv::Point2f(at) + cv::Point2f(kMiddle, kMiddle));
      along = (movedBy(picture->currentFromPrevious, px) - px) / current.reduction();
    }
    cell.imageMotionPx += along;
    cell.temporal = cell.spatial = -1.0;
    errors_[index] = assess(cell, current.picture(), at, scale);
    // Cells that move with the image are compared in turns, not in every frame.
    if (cell.hasChanged && glm::length(along) > kMovingImagePx) {
      cell.waitFrames = kWaitFrames + i % kWaitFrames;
      cell.hasBegun = false;
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
