#include "pipeline/tracking/motion/lucas_kanade_tracker.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <opencv2/imgproc.hpp>

#include "pipeline/tracking/image/homography.h"
#include "pipeline/tracking/motion/cut_detector.h"
#include "pipeline/tracking/motion/image_motion.h"

namespace pleinair::tracking {
namespace {

// A new feature is sought in each empty cell of this grid.
constexpr int kColumns = 18;
constexpr int kRows = 14;
constexpr double kBorderPx = 6.0;
constexpr int kLocalSearchLevels = 1;
constexpr double kMaxForwardBackwardPx = 0.4;  // largest forward-backward error
/// Grey levels (RMS) by which a feature's appearance may differ before it is lost, and before it is
/// stale.
constexpr double kMaxDifference = 20.0;
constexpr double kNoiseDifference = 3.75;
constexpr double kRmsByMean = 1.25;    // ratio for normally distributed differences
constexpr double kLightLevels = 1.5;   // change of brightness beyond which the light has changed
constexpr double kLostContrast = 0.8;  // change of contrast beyond which the light has changed
constexpr double kStaleContrast = 0.25;
// Px of error per level of noise; a feature above this is no corner.
constexpr double kMaxPlacing = 0.12;
constexpr int kMaxMissingFrames = 12;  // frames after which a missing feature is dropped
// Predicted errors; docs/measured.md compares them with true ones.
constexpr double kPlacing = 1.3;  // times the Cramér-Rao bound
constexpr double kMinErrorPx = 0.008;
constexpr double kForwardBackwardPart = 0.5;
/// A new key frame is needed when fewer than this part remains of the features, or of the larger
/// cells with a feature, that the last key frame had …
constexpr double kMinFeatureShare = 0.75;
constexpr double kMinCellShare = 0.88;
constexpr int kFieldCells = 2;  // cells along each side of a larger cell
/// … or when the appearance of this part of the features has changed.
constexpr double kMaxStaleShare = 0.15;
// Least number of frames between two key frames, unless most features are lost.
constexpr int kKeyFrames = 4;
constexpr double kVeryFew = 0.5;
constexpr int kSeekFrames = 8;             // most frames between two searches for new corners …
constexpr std::size_t kMinNewCorners = 4;  // … of which at least this many justify a key frame
/// A feature farther than this from the image's motion moves there if it matches as well there.
constexpr double kAstrayPx = 1.5;
constexpr double kAsGood = 1.2;
constexpr double kAsGoodLevels = 0.5;
constexpr double kLostShare = 0.3;  // fewer found: the whole image may have jumped
constexpr std::size_t kMinToJudge = 12;

double lengthOf(const cv::Point2f& p) {
  return std::sqrt(static_cast<double>(p.dot(p)));
}

}  // namespace

LucasKanadeTracker::LucasKanadeTracker() {
  features_.reserve(kMaxMovedFeatures);
  seen_.reserve(kMaxMovedFeatures);
  LucasKanadeTracker::reset();
}

void LucasKanadeTracker::reset() {
  for (auto& key : keys_) key.reset();
  previous_.reset();
  features_.clear();
  seen_.clear();
  framesSinceKey_ = kSeekFrames;
  foundShare_ = 0.0;
  keySpread_ = {};
}

FeaturePatch LucasKanadeTracker::patchAt(const LumaPyramid& pyramid, const cv::Point2f& at) {
  return {pyramid.picture(), FeaturePatch::middleNear(pyramid.picture(), at)};
}

/// Decides whether the position found by Lucas-Kanade is the feature, and refines it, ignoring
/// brightness.
void LucasKanadeTracker::judge(Feature& feature, const LumaPyramid& current, std::size_t of,
                               const cv::Point2f& found) {
  feature.isFound = follower_.isFound(of) && current.isInside(found, kBorderPx) &&
                    follower_.forwardBackwardPx(of) < kMaxForwardBackwardPx;
  if (!feature.isFound) return;
  const cv::Point2f moved = found - feature.origin;
  PatchMatch match = feature.patch.at(current.picture(), {moved.x, moved.y});
  // Lucas-Kanade takes a change of brightness for motion. Without such a change it locates best.
  const bool hasLightChanged = match.isInside && std::abs(match.brightness) > kLightLevels;
  if (hasLightChanged) match = feature.patch.refined(current.picture(), match, noise_);
  const cv::Point2f at = hasLightChanged
                             ? feature.origin + cv::Point2f(static_cast<float>(match.moved.x),
                                                            static_cast<float>(match.moved.y))
                             : found;
  const double difference =
      match.isInside ? std::sqrt(match.variance) : kRmsByMean * follower_.difference(of);
  const double contrast = feature.patch.contrast();
  feature.isFound =
      difference < kMaxDifference && difference < kNoiseDifference + kLostContrast * contrast;
  if (!feature.isFound) return;
  feature.difference = difference;
  feature.isStale = difference > kNoiseDifference + kStaleContrast * contrast;
  const double placing = kPlacing * difference * feature.patch.placing(noise_, !hasLightChanged);
  const double scale = std::max(current.reduction().x, current.reduction().y);
  feature.errorPx =
      scale * glm::length(glm::dvec3(
                  placing, kForwardBackwardPart * follower_.forwardBackwardPx(of), kMinErrorPx));
  feature.step = at - feature.previous;
  feature.at = at;
}

/// Searches for features not found yet: all of them, or only those found in the previous frame.
void LucasKanadeTracker::find(const LumaPyramid& current, bool all, int levels) {
  for (std::size_t key = 0; key < kKeys; ++key) {
    members_.clear();
    origins_.clear();
    points_.clear();
    for (std::size_t i = 0; i < features_.size(); ++i) {
      const Feature& feature = features_[i];
      if (feature.key != key || feature.isFound || !(all || feature.wasFound)) continue;
      members_.push_back(i);
      origins_.push_back(feature.origin);
      points_.push_back(feature.previous + feature.step);
    }
    if (members_.empty()) continue;
    follower_.follow(*keys_[key], current, origins_, points_, levels);
    for (std::size_t m = 0; m < members_.size(); ++m) {
      judge(features_[members_[m]], current, m, points_[m]);
    }
  }
}

/// Searches again where the whole image may have jumped to.
bool LucasKanadeTracker::searchWidely(const LumaPyramid& current) {
  Thumbnail before;
  Thumbnail after;
  before.load(*previous_);
  after.load(current);
  const Thumbnail::Match match = before.match(after);
  const cv::Size size = current.picture().size();
  const cv::Point2f jump(static_cast<float>(match.shift.x * size.width),
                         static_cast<float>(match.shift.y * size.height));
  constexpr double kMinCorrelation = 0.5;
  if (match.correlation < kMinCorrelation || jump == cv::Point2f()) return false;
  for (Feature& feature : features_) {
    if (!feature.isFound) feature.step = jump;
  }
  find(current, true, LumaPyramid::kLevels);
  return true;
}

void LucasKanadeTracker::rejectOutliers() {
  members_.clear();
  points_.clear();
  steps_.clear();
  for (std::size_t i = 0; i < features_.size(); ++i) {
    const Feature& feature = features_[i];
    if (!feature.isFound || !feature.wasFound) continue;
    members_.push_back(i);
    points_.push_back(feature.at);
    steps_.push_back(feature.step);
  }
  outliers_.judge(points_, steps_);
  for (std::size_t m = 0; m < members_.size(); ++m) {
    if (outliers_.isOutlier(m)) features_[members_[m]].isFound = false;
  }
}

/// Searches again for features that do not follow the image's motion, at the position that it
/// predicts: repeated patterns load alike a few px apart.
void LucasKanadeTracker::reconsider(const LumaPyramid& current) {
  pairs_.clear();
  for (const Feature& feature : features_) {
    if (!feature.isFound || !feature.wasFound) continue;
    pairs_.push_back({.previous = {feature.previous.x, feature.previous.y},
                      .current = {feature.at.x, feature.at.y},
                      .errorPx = feature.errorPx});
  }
  const auto fit = fitter_.fit(pairs_, {current.picture().cols, current.picture().rows});
  if (!fit) return;
  before_ = features_;
  for (Feature& feature : features_) {
    if (!feature.wasFound) continue;
    const glm::dvec2 along =
        movedBy(fit->currentFromPrevious, {feature.previous.x, feature.previous.y});
    const cv::Point2f there(static_cast<float>(along.x), static_cast<float>(along.y));
    if (feature.isFound && lengthOf(feature.at - there) < kAstrayPx) continue;
    feature.isFound = false;
    feature.step = there - feature.previous;
  }
  find(current, false, 0);
  for (std::size_t i = 0; i < features_.size(); ++i) {
    const Feature& was = before_[i];
    Feature& feature = features_[i];
    const bool isWorse =
        !feature.isFound || feature.difference > kAsGood * was.difference + kAsGoodLevels;
    if (was.isFound && isWorse) feature = was;
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

/// Predicts the positions of missing features for the next frame by the motion of the found ones.
void LucasKanadeTracker::guessMissing(const LumaPyramid& current) {
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
    return f.missingFrames > kMaxMissingFrames ||
           (f.missingFrames > 0 && !current.isInside(f.at, -kBorderPx));
  });
}

LucasKanadeTracker::Spread LucasKanadeTracker::spread(const LumaPyramid& current) {
  cells_.assign(static_cast<std::size_t>(kColumns) * kRows, 0);
  const cv::Size size = current.picture().size();
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
  const auto stale = static_cast<std::size_t>(
      std::ranges::count_if(features_, [](const Feature& f) { return f.isFound && f.isStale; }));
  return isBelow(have.features, kMinFeatureShare, keySpread_.features) ||
         isBelow(have.fields, kMinCellShare, keySpread_.fields) ||
         !isBelow(stale, kMaxStaleShare, have.features + 1);
}

void LucasKanadeTracker::takeOver(Feature& feature, std::size_t key, const LumaPyramid& current) {
  feature.key = key;
  feature.origin = feature.at;
  feature.patch = patchAt(current, feature.at);
  feature.isStale = false;
}

/// Returns a free slot for a new key frame, or else the slot of the key frame with the fewest
/// features. The new key frame takes those features over; the ones not visible now lose their
/// appearance.
std::size_t LucasKanadeTracker::freeKey(const LumaPyramid& current) {
  std::array<std::size_t, kKeys> counts{};
  for (const Feature& feature : features_) {
    if (!(feature.isFound && feature.isStale)) ++counts[feature.key];
  }
  const auto key = static_cast<std::size_t>(std::ranges::min_element(counts) - counts.begin());
  std::erase_if(features_, [&](const Feature& f) { return f.key == key && !f.isFound; });
  for (Feature& feature : features_) {
    if (feature.key == key || (feature.isFound && feature.isStale)) takeOver(feature, key, current);
  }
  return key;
}

/// Finds corners in cells without a feature.
void LucasKanadeTracker::findCorners(const LumaPyramid& current) {
  newCorners_.clear();
  const cv::Size size = corners_.size();
  for (int cell = 0; cell < kColumns * kRows; ++cell) {
    if (cells_[static_cast<std::size_t>(cell)] != 0) continue;
    const int column = cell % kColumns;
    const int row = cell / kColumns;
    const cv::Point from(size.width * column / kColumns, size.height * row / kRows);
    const cv::Point to(size.width * (column + 1) / kColumns, size.height * (row + 1) / kRows);
    cv::Point2f at;
    if (!corners_.takeStrongest({from, to}, at) || !current.isInside(at, kBorderPx)) continue;
    const bool isTaken = std::ranges::any_of(features_, [&](const Feature& f) {
      return f.isFound && lengthOf(f.at - at) < CornerSearch::kSpacingPx;
    });
    if (!isTaken && patchAt(current, at).placing(noise_, true) < kMaxPlacing)
      newCorners_.push_back(at);
  }
  centre(current);
}

/// Moves new corners to the point where the surrounding gradients balance (Förstner and Gülch,
/// 1987): there a turn or zoom of the window does not load like a shift.
void LucasKanadeTracker::centre(const LumaPyramid& current) {
  if (newCorners_.empty()) return;
  constexpr int kReach = LumaPyramid::kWindowPx / 2;
  constexpr float kDivergedPx = 4.0F;
  points_ = newCorners_;
  const cv::TermCriteria until(cv::TermCriteria::COUNT | cv::TermCriteria::EPS, 5, 0.1);
  cv::cornerSubPix(current.picture(), points_, {kReach, kReach}, {-1, -1}, until);
  for (std::size_t i = 0; i < points_.size(); ++i) {
    if (lengthOf(points_[i] - newCorners_[i]) < kDivergedPx) newCorners_[i] = points_[i];
  }
}

void LucasKanadeTracker::makeKey(const std::shared_ptr<const LumaPyramid>& current, bool isNeeded) {
  framesSinceKey_ = 0;
  const cv::Size size = current->picture().size();
  if (std::min(size.width, size.height) < 2 * FeaturePatch::kReach || !corners_.load(*current))
    return;
  findCorners(*current);
  if (!isNeeded && newCorners_.size() < kMinNewCorners) return;
  if (features_.size() + newCorners_.size() > kMaxMovedFeatures) {
    std::erase_if(features_, [](const Feature& f) { return !f.isFound; });
  }
  const std::size_t key = freeKey(*current);
  keys_[key] = current;
  for (const cv::Point2f& at : newCorners_) {
    if (features_.size() == kMaxMovedFeatures) break;
    features_.push_back({.id = nextId_++,
                         .key = key,
                         .origin = at,
                         .at = at,
                         .previous = at,
                         .step = {},
                         .patch = patchAt(*current, at),
                         .isFound = true});
  }
  keySpread_ = spread(*current);
}

void LucasKanadeTracker::publish(const LumaPyramid& current) {
  seen_.clear();
  for (const Feature& feature : features_) {
    if (!feature.isFound) continue;
    seen_.push_back({.id = feature.id,
                     .px = current.framePx(feature.at),
                     .errorPx = feature.errorPx,
                     .wasSeen = feature.wasFound,
                     .previousPx = current.framePx(feature.previous)});
  }
}

std::span<const SeenFeature> LucasKanadeTracker::follow(std::shared_ptr<const LumaPyramid> current,
                                                        double noise) {
  noise_ = noise;
  if (previous_ && previous_->frameSize() != current->frameSize()) reset();
  for (Feature& feature : features_) {
    feature.wasFound = feature.isFound;
    feature.isFound = false;
    feature.previous = feature.at;
  }
  // Most features are where their motion predicts; the others may be anywhere near.
  find(*current, false, kLocalSearchLevels);
  find(*current, true, LumaPyramid::kLevels);
  if (previous_ && features_.size() >= kMinToJudge && shareFound() < kLostShare)
    searchWidely(*current);
  reconsider(*current);
  rejectOutliers();
  foundShare_ = shareFound();
  guessMissing(*current);
  ++framesSinceKey_;
  publish(*current);
  const bool isNeeded = needsKey(spread(*current));
  if (isNeeded || framesSinceKey_ >= kSeekFrames) makeKey(current, isNeeded);
  previous_ = std::move(current);
  return seen_;
}

}  // namespace pleinair::tracking
