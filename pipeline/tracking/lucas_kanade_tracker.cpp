#include "pipeline/tracking/lucas_kanade_tracker.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <glm/geometric.hpp>

#include "pipeline/tracking/image_motion.h"
#include "pipeline/tracking/thumbnail.h"

namespace pleinair::tracking {
namespace {

// Features are sought where a field of this grid has none.
constexpr int kColumns = 18;
constexpr int kRows = 14;
constexpr double kBorderPx = 6.0;
constexpr double kBackPx = 0.4;  // from where a feature came
/// Mean grey levels in a feature's window by which it may differ: lost, worn.
constexpr double kLargestDifference = 16.0;
constexpr double kNoiseDifference = 3.0;
constexpr double kLostContrast = 0.8;  // and of the window's contrast
constexpr double kWornContrast = 0.25;
constexpr double kMostPlacing = 0.12;  // px of error by a level of noise: more is no corner
constexpr int kMostMissing = 12;       // frames that a feature is looked for in vain
// Predicted errors: docs/measured.md says how they agree with true ones.
/// Of Cramér and Rao's bound, and of the mean difference's root mean square by it.
constexpr double kPlacing = 1.3 * 1.25;
constexpr double kLeastErrorPx = 0.008;
constexpr double kBackPart = 0.5;
/// Of the features, or of larger fields with one, that there were after the last key frame, the
/// part that is too few …
constexpr double kFew = 0.75;
constexpr double kFewFields = 0.88;
constexpr int kFieldCells = 2;  // on each side of a larger field
/// … or of the features, the part whose looks have changed, which is enough for a new one.
constexpr double kManyWorn = 0.15;
constexpr int kKeyFrames = 4;  // between two key frames, unless most are lost
constexpr double kVeryFew = 0.5;
constexpr int kSeekFrames = 8;        // new corners are looked for that often at least …
constexpr std::size_t kWorthAKey = 4;  // … and so many of them are worth a key frame
constexpr double kLostShare = 0.3;     // fewer found: the whole picture may have jumped
constexpr std::size_t kLeastToJudge = 12;
constexpr std::size_t kNeighbours = 6;
constexpr double kAlikePx = 1.5;
constexpr double kAlikePart = 0.25;

double lengthOf(const cv::Point2f& p) {
  return std::hypot(static_cast<double>(p.x), static_cast<double>(p.y));
}

}  // namespace

LucasKanadeTracker::LucasKanadeTracker() {
  features_.reserve(kMostMovedFeatures);
  seen_.reserve(kMostMovedFeatures);
  reset();
}

void LucasKanadeTracker::reset() {
  for (auto& key : keys_) key.reset();
  then_.reset();
  features_.clear();
  seen_.clear();
  framesSinceKey_ = kSeekFrames;
  foundShare_ = 0.0;
  keySpread_ = {};
}

/// From the gradients in the window (Cramér and Rao's bound).
LucasKanadeTracker::Texture LucasKanadeTracker::textureAt(const LumaPyramid& pyramid,
                                                          const cv::Point2f& at) {
  constexpr int kReach = LumaPyramid::kWindowPx / 2;
  const cv::Mat& picture = pyramid.picture();
  const cv::Mat& gradients = pyramid.levels()[1];
  const cv::Rect window(static_cast<int>(std::lround(at.x)) - kReach,
                        static_cast<int>(std::lround(at.y)) - kReach, 2 * kReach + 1,
                        2 * kReach + 1);
  const cv::Rect inside = window & cv::Rect({}, picture.size());
  if (inside.empty()) return {.placing = kMostPlacing * 2.0};
  double xx = 0.0;
  double xy = 0.0;
  double yy = 0.0;
  const double mean = cv::mean(picture(inside))[0];
  double deviation = 0.0;
  for (int y = inside.y; y < inside.br().y; ++y) {
    for (int x = inside.x; x < inside.br().x; ++x) {
      const auto g = gradients.at<cv::Vec2s>(y, x);
      xx += static_cast<double>(g[0]) * g[0];
      xy += static_cast<double>(g[0]) * g[1];
      yy += static_cast<double>(g[1]) * g[1];
      deviation += std::abs(picture.at<std::uint8_t>(y, x) - mean);
    }
  }
  constexpr double kGradientScale = 32.0;
  const double determinant = xx * yy - xy * xy;
  const double trace = xx + yy;
  // The trace of the inverse, and its least value where the matrix has none.
  const double inverse = determinant > 1e-9 * trace * trace ? trace / determinant : 1e6;
  return {.placing = kGradientScale * std::sqrt(inverse),
          .contrast = deviation / static_cast<double>(inside.area())};
}

void LucasKanadeTracker::judge(Feature& feature, const LumaPyramid& now, std::size_t of,
                               const cv::Point2f& at) {
  const double difference = follower_.difference(of);
  const double contrast = feature.texture.contrast;
  feature.isFound = follower_.isFound(of) && now.isInside(at, kBorderPx) &&
                    follower_.backPx(of) < kBackPx && difference < kLargestDifference &&
                    difference < kNoiseDifference + kLostContrast * contrast;
  if (!feature.isFound) return;
  feature.isWorn = difference > kNoiseDifference + kWornContrast * contrast;
  const double placing = kPlacing * difference * feature.texture.placing;
  const double scale = std::max(now.reduction().x, now.reduction().y);
  feature.errorPx = scale * std::hypot(placing, kBackPart * follower_.backPx(of), kLeastErrorPx);
  feature.step = at - feature.then;
  feature.at = at;
}

void LucasKanadeTracker::findAll(const LumaPyramid& now, bool isRetry) {
  for (std::size_t key = 0; key < kKeys; ++key) {
    members_.clear();
    origins_.clear();
    points_.clear();
    for (std::size_t i = 0; i < features_.size(); ++i) {
      const Feature& feature = features_[i];
      if (feature.key != key || (isRetry && feature.isFound)) continue;
      members_.push_back(i);
      origins_.push_back(feature.origin);
      points_.push_back(feature.then + feature.step);
    }
    if (members_.empty()) continue;
    follower_.follow(*keys_[key], now, origins_, points_);
    for (std::size_t m = 0; m < members_.size(); ++m) {
      judge(features_[members_[m]], now, m, points_[m]);
    }
  }
}

/// Looks for the features again where the picture as a whole may have jumped to.
bool LucasKanadeTracker::searchWidely(const LumaPyramid& now) {
  Thumbnail before;
  Thumbnail after;
  before.load(*then_);
  after.load(now);
  const Thumbnail::Match match = before.match(after);
  const cv::Size size = now.picture().size();
  const cv::Point2f jump(static_cast<float>(match.shift.x * size.width),
                         static_cast<float>(match.shift.y * size.height));
  constexpr double kLeastCorrelation = 0.5;
  if (match.correlation < kLeastCorrelation || jump == cv::Point2f()) return false;
  for (Feature& feature : features_) {
    if (!feature.isFound) feature.step = jump;
  }
  findAll(now, true);
  return true;
}

/// A feature whose neighbours all move otherwise has been mistaken for another.
void LucasKanadeTracker::rejectOutliers() {
  isOutlier_.assign(features_.size(), 0);
  const auto isMeasured = [](const Feature& f) { return f.isFound && f.wasFound; };
  if (std::cmp_less(std::ranges::count_if(features_, isMeasured), kLeastToJudge)) return;
  for (std::size_t i = 0; i < features_.size(); ++i) {
    const Feature& feature = features_[i];
    if (!isMeasured(feature)) continue;
    std::array<std::pair<double, std::size_t>, kNeighbours> near;
    near.fill({1e9, 0});
    for (std::size_t j = 0; j < features_.size(); ++j) {
      if (j == i || !isMeasured(features_[j])) continue;
      const double apart = lengthOf(features_[j].at - feature.at);
      if (apart >= near.back().first) continue;
      near.back() = {apart, j};
      for (std::size_t k = kNeighbours - 1; k > 0 && near[k].first < near[k - 1].first; --k) {
        std::swap(near[k], near[k - 1]);
      }
    }
    const double tolerance = std::max(kAlikePx, kAlikePart * lengthOf(feature.step));
    const auto alike = std::ranges::count_if(near, [&](const auto& other) {
      return lengthOf(features_[other.second].step - feature.step) < tolerance;
    });
    isOutlier_[i] = alike == 0 ? 1 : 0;
  }
  for (std::size_t i = 0; i < features_.size(); ++i) {
    if (isOutlier_[i] != 0) features_[i].isFound = false;
  }
}

double LucasKanadeTracker::shareFound() const {
  double before = 0.0;
  double found = 0.0;
  for (const Feature& feature : features_) {
    if (!feature.wasFound) continue;
    before += 1.0;
    found += feature.isFound ? 1.0 : 0.0;
  }
  return before > 0.0 ? found / before : 0.0;
}

/// What was not found is looked for next time where the found ones go.
void LucasKanadeTracker::guessMissing(const LumaPyramid& now) {
  cv::Point2f shift(0.0F, 0.0F);
  float count = 0.0F;
  for (const Feature& feature : features_) {
    if (!feature.isFound || !feature.wasFound) continue;
    shift += feature.step;
    count += 1.0F;
  }
  if (count > 0.0F) shift *= 1.0F / count;
  for (Feature& feature : features_) {
    feature.missingFrames = feature.isFound ? 0 : feature.missingFrames + 1;
    if (feature.isFound) {
      if (!feature.wasFound) feature.step = shift;
    } else {
      feature.at += shift;
      feature.step = shift;
    }
  }
  std::erase_if(features_, [&](const Feature& f) {
    return f.missingFrames > kMostMissing ||
           (f.missingFrames > 0 && !now.isInside(f.at, -kBorderPx));
  });
}

LucasKanadeTracker::Spread LucasKanadeTracker::spread(const LumaPyramid& now) {
  cells_.assign(static_cast<std::size_t>(kColumns) * kRows, 0);
  const cv::Size size = now.picture().size();
  Spread out;
  for (const Feature& feature : features_) {
    if (!feature.isFound) continue;
    ++out.features;
    const int column = static_cast<int>(feature.at.x) * kColumns / size.width;
    const int row = static_cast<int>(feature.at.y) * kRows / size.height;
    cells_[static_cast<std::size_t>(row * kColumns + column)] = 1;
  }
  for (int row = 0; row < kRows; row += kFieldCells) {
    for (int column = 0; column < kColumns; column += kFieldCells) {
      const auto* const cell = &cells_[static_cast<std::size_t>(row * kColumns + column)];
      out.fields += (cell[0] | cell[1] | cell[kColumns] | cell[kColumns + 1]) != 0 ? 1U : 0U;
    }
  }
  return out;
}

bool LucasKanadeTracker::needsKey(const Spread& have) const {
  const auto isBelow = [](std::size_t count, double part, std::size_t of) {
    return static_cast<double>(count) < part * static_cast<double>(of);
  };
  if (isBelow(have.features, kVeryFew, keySpread_.features)) return true;
  if (framesSinceKey_ < kKeyFrames) return false;
  const auto worn = static_cast<std::size_t>(
      std::ranges::count_if(features_, [](const Feature& f) { return f.isFound && f.isWorn; }));
  return isBelow(have.features, kFew, keySpread_.features) ||
         isBelow(have.fields, kFewFields, keySpread_.fields) ||
         !isBelow(worn, kManyWorn, have.features + 1);
}

void LucasKanadeTracker::takeOver(Feature& feature, std::size_t key, const LumaPyramid& now) {
  feature.key = key;
  feature.origin = feature.at;
  feature.texture = textureAt(now, feature.at);
  feature.isWorn = false;
}

/// A place for a new key frame: a free one, or that of the key frame with the fewest features,
/// which the new one takes over; of those that are not seen now the looks are lost.
std::size_t LucasKanadeTracker::freeKey(const LumaPyramid& now) {
  std::array<std::size_t, kKeys> counts{};
  for (const Feature& feature : features_) {
    if (!(feature.isFound && feature.isWorn)) ++counts[feature.key];
  }
  const auto key = static_cast<std::size_t>(std::ranges::min_element(counts) - counts.begin());
  std::erase_if(features_, [&](const Feature& f) { return f.key == key && !f.isFound; });
  for (Feature& feature : features_) {
    if (feature.key == key || (feature.isFound && feature.isWorn)) takeOver(feature, key, now);
  }
  return key;
}

/// Corners where there is no feature.
void LucasKanadeTracker::findCorners(const LumaPyramid& now) {
  newCorners_.clear();
  const cv::Size size = corners_.size();
  for (int cell = 0; cell < kColumns * kRows; ++cell) {
    if (cells_[static_cast<std::size_t>(cell)] != 0) continue;
    const int column = cell % kColumns;
    const int row = cell / kColumns;
    const cv::Point from(size.width * column / kColumns, size.height * row / kRows);
    const cv::Point to(size.width * (column + 1) / kColumns, size.height * (row + 1) / kRows);
    cv::Point2f at;
    if (!corners_.takeBest({from, to}, at) || !now.isInside(at, kBorderPx)) continue;
    const bool isTaken = std::ranges::any_of(features_, [&](const Feature& f) {
      return f.isFound && lengthOf(f.at - at) < CornerSearch::kSpacingPx;
    });
    if (!isTaken && textureAt(now, at).placing < kMostPlacing) newCorners_.push_back(at);
  }
}

void LucasKanadeTracker::makeKey(const std::shared_ptr<const LumaPyramid>& now, bool isNeeded) {
  framesSinceKey_ = 0;
  if (!corners_.look(*now)) return;  // too small a picture
  findCorners(*now);
  if (!isNeeded && newCorners_.size() < kWorthAKey) return;
  if (features_.size() + newCorners_.size() > kMostMovedFeatures) {
    std::erase_if(features_, [](const Feature& f) { return !f.isFound; });
  }
  const std::size_t key = freeKey(*now);
  keys_[key] = now;
  for (const cv::Point2f& at : newCorners_) {
    if (features_.size() == kMostMovedFeatures) break;
    features_.push_back({.id = nextId_++,
                         .key = key,
                         .origin = at,
                         .at = at,
                         .then = at,
                         .step = {},
                         .texture = textureAt(*now, at),
                         .isFound = true});
  }
  keySpread_ = spread(*now);
}

void LucasKanadeTracker::publish(const LumaPyramid& now) {
  seen_.clear();
  for (const Feature& feature : features_) {
    if (!feature.isFound) continue;
    seen_.push_back({.id = feature.id,
                     .px = now.framePx(feature.at),
                     .errorPx = feature.errorPx,
                     .wasSeen = feature.wasFound,
                     .thenPx = now.framePx(feature.then)});
  }
}

std::span<const SeenFeature> LucasKanadeTracker::follow(std::shared_ptr<const LumaPyramid> now) {
  if (then_ && then_->frameSize() != now->frameSize()) reset();
  for (Feature& feature : features_) {
    feature.wasFound = feature.isFound;
    feature.isFound = false;
    feature.then = feature.at;
  }
  findAll(*now, false);
  if (then_ && features_.size() >= kLeastToJudge && shareFound() < kLostShare) searchWidely(*now);
  rejectOutliers();
  foundShare_ = shareFound();
  guessMissing(*now);
  ++framesSinceKey_;
  publish(*now);
  const bool isNeeded = needsKey(spread(*now));
  if (isNeeded || framesSinceKey_ >= kSeekFrames) makeKey(now, isNeeded);
  then_ = std::move(now);
  return seen_;
}

}  // namespace pleinair::tracking
