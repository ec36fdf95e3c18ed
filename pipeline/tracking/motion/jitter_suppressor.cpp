#include "pipeline/tracking/motion/jitter_suppressor.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

#include "hal/median.h"
#include "pipeline/tracking/image/homography.h"
#include "pipeline/tracking/motion/feature_places.h"

namespace pleinair::tracking {
namespace {

/// Motion below this (px of the measured image), or below this many predicted errors, is
/// suppressed.
constexpr double kBandPx = 0.1;
constexpr double kFeatureErrors = 4.5;
constexpr double kPictureErrors = 4.0;
/// A feature is released after this many frames beyond its band, or after one frame at twice the
/// band.
constexpr int kFramesBeyond = 2;
constexpr double kFarBeyond = 2.0;
/// Frames within the band after which a feature is held again.
constexpr int kQuietFrames = 8;
constexpr double kMinErrorPx = 0.005;
constexpr double kCalibrationPace = 0.15;  // weight of one frame
constexpr double kMinCalibration = 0.7;
constexpr double kMaxCalibration = 3.0;

/// A feature that has moved by less may be at rest.
double bandOf(const PointPair& pair, double scale) {
  return std::max(kBandPx * scale, kFeatureErrors * pair.errorPx);
}

bool isAtRest(const PointPair& pair, double scale) {
  return glm::distance(pair.previous, pair.current) <= bandOf(pair, scale);
}

}  // namespace

void JitterSuppressor::reset() {
  reported_.clear();
  sway_.reset();
  motions_.clear();
  picture_.reset();
  isHeld_ = true;
  quietMotion_ = glm::dmat3(1.0);
  quietFrames_ = 0;
  calibration_ = 1.0;
}

void JitterSuppressor::match(std::span<const SeenFeature> seen) {
  next_.clear();
  auto known = reported_.begin();
  for (const SeenFeature& feature : seen) {
    while (known != reported_.end() && known->id < feature.id) ++known;
    const bool isKnown = known != reported_.end() && known->id == feature.id;
    ReportedFeature reported{.id = feature.id, .px = feature.previousPx, .isHeld = isHeld_};
    if (isKnown && feature.wasSeen) reported = *known;
    reported.isNew = !feature.wasSeen;
    if (reported.isNew) reported.px = feature.px;
    reported.agrees = false;
    reported.errorPx = calibration_ * feature.errorPx;
    reported.seenPx = feature.px;
    next_.push_back(reported);
  }
  std::swap(reported_, next_);
}

void JitterSuppressor::suppressJitter(const HomographyFit& fit, hal::FrameSize size, double scale) {
  const double moved = rmsMotion(fit.currentFromPrevious, size);
  const double bandPx = std::max(kBandPx * scale, kPictureErrors * fit.fitErrorPx);
  if (moved > bandPx) {
    isHeld_ = false;
    quietMotion_ = glm::dmat3(1.0);
    quietFrames_ = 0;
    picture_ = ImageHomography{
        .currentFromPrevious = fit.currentFromPrevious,
        .errorPx = std::hypot(fit.fitErrorPx, fit.modelErrorPx, kMinErrorPx * scale)};
    return;
  }
  picture_ = ImageHomography{.currentFromPrevious = glm::dmat3(1.0),
                             .errorPx = std::hypot(moved, fit.modelErrorPx, kMinErrorPx * scale)};
}

void JitterSuppressor::releasePicture(const HomographyFit& fit, hal::FrameSize size, double scale) {
  picture_ =
      ImageHomography{.currentFromPrevious = fit.currentFromPrevious,
                      .errorPx = std::hypot(fit.fitErrorPx, fit.modelErrorPx, kMinErrorPx * scale)};
  quietMotion_ = fit.currentFromPrevious * quietMotion_;
  ++quietFrames_;
  const double bandPx = std::max(kBandPx * scale, kPictureErrors * fit.fitErrorPx);
  if (rmsMotion(quietMotion_, size) > bandPx) {
    quietMotion_ = glm::dmat3(1.0);
    quietFrames_ = 0;
  } else if (quietFrames_ >= kQuietFrames) {
    isHeld_ = true;
    isSettling_ = true;
  }
}

/// Places count and not features: a plain wall has few of them, a jacket many.
JitterSuppressor::PlaceCounts JitterSuppressor::countPlaces(const HomographyFit& fit,
                                                            hal::FrameSize size,
                                                            double scale) const {
  FeaturePlaces seen;
  FeaturePlaces atRest;
  FeaturePlaces contradicted;
  FeaturePlaces hit;
  for (const PointPair& pair : pairs_) {
    const std::size_t place = placeOf(pair.current, size);
    const double bandPx = bandOf(pair, scale);
    const glm::dvec2 fitted = movedBy(fit.currentFromPrevious, pair.previous);
    const bool rests = isAtRest(pair, scale);
    seen.set(place);
    if (rests) atRest.set(place);
    if (glm::distance(fitted, pair.previous) <= bandPx) continue;
    if (rests) contradicted.set(place);
    if (glm::distance(fitted, pair.current) <= bandPx) hit.set(place);
  }
  return {.seen = seen.count(),
          .atRest = atRest.count(),
          .contradicted = contradicted.count(),
          .hit = hit.count()};
}

/// A homography has room for the motion of a large thing that moves before a camera that stands,
/// and even for a part of it: half of the image at rest, half of it moving looks like a shear.
/// Where the fit contradicts what is at rest in more places than it hits, and most of the image is
/// at rest, the camera stands.
bool JitterSuppressor::contradictsRest(const PlaceCounts& places) const {
  constexpr std::size_t kLeastPlaces = 4;
  // While the camera has stood until now, half as much will do.
  const std::size_t weight = isHeld_ ? 2 : 1;
  return places.contradicted >= kLeastPlaces && weight * places.contradicted >= places.hit &&
         2 * places.atRest >= places.seen;
}

/// A homography also has room for a mover between things at rest, without contradicting any. Where
/// a good part of the image hardly moves, and the fit, if there is one, says less well how than no
/// motion would, the camera stands. Errors are those that were predicted: calibrated ones have
/// grown with the mover.
bool JitterSuppressor::restSpeaksAgainst(const std::optional<HomographyFit>& fit,
                                         hal::FrameSize size, double scale) {
  const std::size_t leastAtRest = fit ? 8 : 4;
  FeaturePlaces seen;
  FeaturePlaces atRest;
  apart_.clear();
  moved_.clear();
  for (const PointPair& pair : pairs_) {
    const std::size_t place = placeOf(pair.current, size);
    seen.set(place);
    PointPair predicted = pair;
    predicted.errorPx /= calibration_;
    if (!isAtRest(predicted, scale)) continue;
    atRest.set(place);
    moved_.push_back(glm::distance(pair.previous, pair.current) / pair.errorPx);
    if (!fit) continue;
    const glm::dvec2 fitted = movedBy(fit->currentFromPrevious, pair.previous);
    apart_.push_back(glm::distance(fitted, pair.current) / pair.errorPx);
  }
  if (atRest.count() < leastAtRest || 3 * atRest.count() < seen.count()) return false;
  return !fit || hal::medianOf(apart_) > hal::medianOf(moved_);
}

/// Whether a mounted camera has been pushed: all over the image, nearly everything moves as one,
/// and next to nothing is at rest. Somebody who is close leaves some of the image.
bool JitterSuppressor::isShifted(const PlaceCounts& places) {
  constexpr std::size_t kLeastPlaces = kPlaces * 2 / 3;
  return places.seen >= kLeastPlaces && 10 * places.hit >= 8 * places.seen &&
         10 * places.atRest <= places.seen;
}

/// Predictions assume white noise; a compressed movie's noise is not white. The features that
/// follow the image best show by how much predictions are wrong, even where the scene is no plane.
void JitterSuppressor::calibrate(const HomographyFit& fit) {
  ratios_.clear();
  for (const PointPair& pair : pairs_) {
    const double off = glm::distance(movedBy(fit.currentFromPrevious, pair.previous), pair.current);
    ratios_.push_back(off / pair.errorPx);
  }
  const auto quarter = ratios_.begin() + static_cast<std::ptrdiff_t>(ratios_.size() / 4);
  std::nth_element(ratios_.begin(), quarter, ratios_.end());
  // The lowest quarter of normal deviations over two axes is below this part of their RMS.
  constexpr double kQuarterOfNormal = 0.536;
  const double ratio = calibration_ * *quarter / kQuarterOfNormal;
  calibration_ += kCalibrationPace * (ratio - calibration_);
  calibration_ = std::clamp(calibration_, kMinCalibration, kMaxCalibration);
}

void JitterSuppressor::movePicture(hal::FrameSize size, double scale, bool standsBeforeSway) {
  // Motion is measured from the reported positions; while the image is held, from those of held
  // features too.
  pairs_.clear();
  pairOf_.clear();
  for (std::size_t i = 0; i < reported_.size(); ++i) {
    const ReportedFeature& reported = reported_[i];
    if (reported.isNew || (isHeld_ && !reported.isHeld)) continue;
    pairs_.push_back(
        {.previous = reported.px, .current = reported.seenPx, .errorPx = reported.errorPx});
    pairOf_.push_back(i);
  }
  picture_.reset();
  isSettling_ = false;
  auto fit = fitter_.fit(pairs_, size);
  const PlaceCounts places = fit ? countPlaces(*fit, size, scale) : PlaceCounts{};
  const bool stands = isMounted_ ? !isShifted(places)
                                 : standsBeforeSway || contradictsRest(places) ||
                                       restSpeaksAgainst(fit, size, scale);
  for (std::size_t i = 0; i < pairs_.size(); ++i) {
    reported_[pairOf_[i]].agrees = stands ? isAtRest(pairs_[i], scale) : fit && fitter_.agrees(i);
  }
  if (!fit) {
    const bool isKnown = stands && (isHeld_ || isMounted_);
    if (isKnown) picture_ = ImageHomography{.errorPx = kMinErrorPx * scale};
    return;
  }
  if (stands) fit->currentFromPrevious = glm::dmat3(1.0);
  // The rest of features that mostly move says nothing of their errors.
  if (!stands || 2 * places.atRest >= places.seen) calibrate(*fit);
  if (isHeld_) {
    suppressJitter(*fit, size, scale);
  } else {
    releasePicture(*fit, size, scale);
  }
}

void JitterSuppressor::moveFeature(ReportedFeature& reported, double scale) {
  const double bandPx = std::max(kBandPx * scale, kFeatureErrors * reported.errorPx);
  if (reported.isHeld) {
    const double away = glm::distance(reported.seenPx, reported.px);
    reported.beyondFrames = away > bandPx ? reported.beyondFrames + 1 : 0;
    const bool followsImage = reported.agrees && !isHeld_;
    if (!followsImage && reported.beyondFrames < kFramesBeyond && away < kFarBeyond * bandPx)
      return;
    reported.isHeld = false;
    reported.quietFrames = 0;
    reported.quietFrom = reported.seenPx;
    reported.beyondFrames = 0;
  } else if (glm::distance(reported.seenPx, reported.quietFrom) > bandPx) {
    reported.quietFrom = reported.seenPx;
    reported.quietFrames = 0;
  } else if (++reported.quietFrames >= kQuietFrames || (isSettling_ && reported.agrees)) {
    reported.isHeld = isHeld_ || !reported.agrees;
  }
  reported.px = reported.seenPx;
}

void JitterSuppressor::update(std::span<const SeenFeature> seen, hal::FrameSize size,
                              double scale) {
  match(seen);
  movePicture(size, scale, !isMounted_ && sway_.stands(seen, size, scale));
  motions_.clear();
  for (ReportedFeature& reported : reported_) {
    const glm::dvec2 previous = reported.px;
    if (reported.isNew) continue;
    moveFeature(reported, scale);
    motions_.push_back({.id = reported.id,
                        .previous = glm::vec2(previous),
                        .current = glm::vec2(reported.px),
                        .errorPx = static_cast<float>(reported.errorPx)});
  }
}

}  // namespace pleinair::tracking
