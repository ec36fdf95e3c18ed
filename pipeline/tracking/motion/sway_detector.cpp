#include "pipeline/tracking/motion/sway_detector.h"

#include <algorithm>

#include <glm/geometric.hpp>

#include "pipeline/tracking/motion/feature_places.h"
#include "pipeline/tracking/motion/image_motion.h"

namespace pleinair::tracking {
namespace {

constexpr int kLeastFrames = 8;  // over which features are compared
constexpr int kMostFrames = 16;  // while the camera moves
constexpr int kSureFrames = 4;   // so long they must scatter
constexpr std::size_t kLeastFeatures = 24;
constexpr std::size_t kLeastPlaces = 12;
/// Features scatter where a similarity leaves more than this part of their distances …
constexpr double kLeftOver = 0.5;
/// … and these are no larger, px of the measured image: with parallax, a camera's motion is no
/// similarity, either.
constexpr double kMostPx = 1.5;

/// The similarity that takes `from` to `to` with the least squares, each weighed by the inverse of
/// its distance in the round before, so that what goes another way counts little.
PlaneSimilarity similarityOf(std::span<const glm::dvec2> from, std::span<const glm::dvec2> to,
                             double leastPx) {
  constexpr int kRounds = 4;
  PlaneSimilarity fit;
  for (int round = 0; round < kRounds; ++round) {
    double weights = 0.0;
    glm::dvec2 fromMean(0.0);
    glm::dvec2 toMean(0.0);
    const auto weightOf = [&](std::size_t i) {
      return 1.0 / std::max(glm::distance(fit(from[i]), to[i]), leastPx);
    };
    for (std::size_t i = 0; i < from.size(); ++i) {
      const double weight = weightOf(i);
      weights += weight;
      fromMean += weight * from[i];
      toMean += weight * to[i];
    }
    fromMean /= weights;
    toMean /= weights;
    glm::dvec2 products(0.0);
    double squares = 0.0;
    for (std::size_t i = 0; i < from.size(); ++i) {
      const double weight = weightOf(i);
      const glm::dvec2 a = from[i] - fromMean;
      products += weight * PlaneSimilarity::product({a.x, -a.y}, to[i] - toMean);
      squares += weight * glm::dot(a, a);
    }
    if (squares <= 0.0) return fit;
    fit.linear = products / squares;
    fit.shift = toMean - PlaneSimilarity::product(fit.linear, fromMean);
  }
  return fit;
}

}  // namespace

void SwayDetector::reset() {
  reference_.clear();
  frames_ = 0;
  scattered_ = 0;
}

void SwayDetector::keep(std::span<const SeenFeature> seen) {
  reference_.clear();
  for (const SeenFeature& feature : seen) reference_.push_back({feature.id, feature.px});
  frames_ = 0;
}

void SwayDetector::match(std::span<const SeenFeature> seen) {
  from_.clear();
  to_.clear();
  auto known = reference_.begin();
  for (const SeenFeature& feature : seen) {
    while (known != reference_.end() && known->id < feature.id) ++known;
    if (known == reference_.end() || known->id != feature.id) continue;
    from_.push_back(known->px);
    to_.push_back(feature.px);
  }
}

bool SwayDetector::scatters(hal::FrameSize size, double scale) {
  FeaturePlaces places;
  for (const glm::dvec2& px : to_) places.set(placeOf(px, size));
  if (from_.size() < kLeastFeatures || places.count() < kLeastPlaces) return false;
  constexpr double kLeastPx = 0.05;
  const PlaneSimilarity fit = similarityOf(from_, to_, kLeastPx * scale);
  distances_.clear();
  residuals_.clear();
  for (std::size_t i = 0; i < from_.size(); ++i) {
    distances_.push_back(glm::distance(from_[i], to_[i]));
    residuals_.push_back(glm::distance(fit(from_[i]), to_[i]));
  }
  const double distance = medianOf(distances_);
  return distance <= kMostPx * scale && medianOf(residuals_) >= kLeftOver * distance;
}

bool SwayDetector::stands(std::span<const SeenFeature> seen, hal::FrameSize size, double scale) {
  ++frames_;
  match(seen);
  if (2 * from_.size() < std::max(reference_.size(), seen.size())) {
    // Half of them are others: the new ones say nothing yet.
    keep(seen);
    scattered_ = 0;
    return false;
  }
  scattered_ = frames_ >= kLeastFrames && scatters(size, scale) ? scattered_ + 1 : 0;
  if (scattered_ == 0 && frames_ >= kMostFrames) keep(seen);
  return scattered_ >= kSureFrames;
}

}  // namespace pleinair::tracking
