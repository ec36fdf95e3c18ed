#include "pipeline/tracking/motion/sway_detector.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <glm/geometric.hpp>

#include "hal/median.h"
#include "pipeline/tracking/motion/feature_places.h"
#include "pipeline/tracking/motion/image_motion.h"
#include "pipeline/tracking/motion/similarity_fit.h"

namespace pleinair::tracking {
namespace {

constexpr int kLeastFrames = 16;  // over which features are compared
constexpr int kMostFrames = 64;   // after which those of a camera that moves are compared anew
constexpr int kSureFrames = 4;    // so long they must scatter
constexpr int kTrustedFrames = 2 * kLeastFrames;
constexpr std::size_t kLeastFeatures = 24;
constexpr std::size_t kLeastPlaces = 12;
/// Features scatter where a similarity leaves more than this part of their distances …
constexpr double kLeftOver = 0.5;
/// … these are no larger, px of the measured image, …
constexpr double kMostPx = 1.5;
/// … and larger than so many predicted errors: else nothing moves, or too little to tell, …
constexpr double kLeastErrors = 3.0;
/// … and features do not go on as they went: parallax is no similarity, either.
constexpr double kMostCorrelation = 0.5;

/// The similarity that takes `from` to `to`, each weighed by the inverse of its distance in the
/// round before, so that what goes another way counts little.
PlaneSimilarity similarityOf(std::span<const glm::dvec2> from, std::span<const glm::dvec2> to,
                             double leastPx) {
  constexpr int kRounds = 4;
  PlaneSimilarity nearest;
  for (int round = 0; round < kRounds; ++round) {
    SimilarityFit fit;
    for (std::size_t i = 0; i < from.size(); ++i) {
      const double apartPx = glm::distance(nearest(from[i]), to[i]);
      fit.add(from[i], to[i], 1.0 / std::max(apartPx, leastPx));
    }
    nearest = fit.nearest().value_or(nearest);
  }
  return nearest;
}

}  // namespace

void SwayDetector::reset() {
  reference_.clear();
  frames_ = 0;
  scattered_ = 0;
  together_ = 0;
  trusted_ = 0;
}

void SwayDetector::begin(std::span<const SeenFeature> seen) {
  reference_.clear();
  for (const SeenFeature& feature : seen) reference_.push_back({feature.id, feature.px});
  middle_ = reference_;
  latest_ = reference_;
  frames_ = 0;
  scattered_ = 0;
  together_ = 0;
}

/// At each power of two, so that the middle is a quarter to a half of the time ago.
void SwayDetector::keepMiddle(std::span<const SeenFeature> seen) {
  if ((frames_ & (frames_ - 1)) != 0) return;
  std::swap(middle_, latest_);
  latest_.clear();
  for (const SeenFeature& feature : seen) latest_.push_back({feature.id, feature.px});
}

void SwayDetector::match(std::span<const SeenFeature> seen) {
  from_.clear();
  between_.clear();
  to_.clear();
  hasBetween_.clear();
  errors_.clear();
  auto known = reference_.begin();
  auto middle = middle_.begin();
  for (const SeenFeature& feature : seen) {
    while (known != reference_.end() && known->id < feature.id) ++known;
    while (middle != middle_.end() && middle->id < feature.id) ++middle;
    if (known == reference_.end() || known->id != feature.id) continue;
    const bool hasBetween = middle != middle_.end() && middle->id == feature.id;
    from_.push_back(known->px);
    between_.push_back(hasBetween ? middle->px : known->px);
    to_.push_back(feature.px);
    hasBetween_.push_back(hasBetween);
    errors_.push_back(feature.errorPx);
  }
}

SwayDetector::Comparison SwayDetector::compare(hal::FrameSize size, double scale) {
  FeaturePlaces places;
  for (const glm::dvec2& px : to_) places.set(placeOf(px, size));
  if (from_.size() < kLeastFeatures || places.count() < kLeastPlaces) return {};
  constexpr double kLeastPx = 0.05;
  const PlaneSimilarity fit = similarityOf(from_, to_, kLeastPx * scale);
  distances_.clear();
  residuals_.clear();
  double products = 0.0;
  glm::dvec2 squares(0.0);
  for (std::size_t i = 0; i < from_.size(); ++i) {
    distances_.push_back(glm::distance(from_[i], to_[i]));
    residuals_.push_back(glm::distance(fit(from_[i]), to_[i]));
    if (!hasBetween_[i]) continue;
    const glm::dvec2 before = between_[i] - from_[i];
    const glm::dvec2 after = to_[i] - between_[i];
    products += glm::dot(before, after);
    squares += glm::dvec2(glm::dot(before, before), glm::dot(after, after));
  }
  const double lengths = std::sqrt(squares.x * squares.y);
  return {.distancePx = hal::medianOf(distances_),
          .residualPx = hal::medianOf(residuals_),
          .errorPx = hal::medianOf(errors_),
          .correlation = lengths > 0.0 ? products / lengths : 0.0,
          .isKnown = true};
}

bool SwayDetector::stands(std::span<const SeenFeature> seen, hal::FrameSize size, double scale) {
  ++frames_;
  match(seen);
  if (2 * from_.size() < std::max(reference_.size(), seen.size())) {
    // Half of them are others, as where somebody passes: the new ones say nothing yet.
    trusted_ = scattered_ >= kSureFrames ? kTrustedFrames : trusted_;
    begin(seen);
  } else {
    const Comparison now = compare(size, scale);
    const bool isNear = now.isKnown && now.distancePx <= kMostPx * scale;
    const bool isApart = now.residualPx >= kLeftOver * now.distancePx;
    const bool isClear = now.distancePx >= kLeastErrors * now.errorPx;
    const bool wasKnown = scattered_ >= kSureFrames;
    const bool comesBack = wasKnown || now.correlation <= kMostCorrelation;
    // Leaves of one tree may be back all at once, and what little is left may then be alike.
    together_ = isClear && !isApart ? together_ + 1 : 0;
    const bool isTogether = together_ >= (wasKnown || trusted_ > 0 ? kSureFrames : 1);
    if (!isNear || isTogether || (isClear && !comesBack)) {
      scattered_ = 0;
      trusted_ = isNear && !isTogether ? trusted_ : 0;
    } else if (isClear && isApart && frames_ >= kLeastFrames) {
      ++scattered_;  // where nothing is clear, what was known still holds
    }
    keepMiddle(seen);
    if (scattered_ == 0 && frames_ >= kMostFrames) begin(seen);
  }
  trusted_ = std::max(trusted_ - 1, 0);
  return scattered_ >= kSureFrames || trusted_ > 0;
}

}  // namespace pleinair::tracking
