#include "pipeline/tracking/motion/picture_hold.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

#include "pipeline/tracking/image/homography.h"

namespace pleinair::tracking {
namespace {

/// What moves less than this (px of the picture that is measured), or than so many predicted
/// errors, is held.
constexpr double kBandPx = 0.1;
constexpr double kFeatureErrors = 4.5;
constexpr double kPictureErrors = 4.0;
/// A feature is let go when it is beyond its band in so many frames, or twice as far in one.
constexpr int kFramesBeyond = 2;
constexpr double kFarBeyond = 2.0;
/// What has stayed within its band for so long is held again.
constexpr int kQuietFrames = 8;
constexpr double kLeastErrorPx = 0.005;
constexpr double kCalibrationPace = 0.15;  // the part of a frame
constexpr double kLeastCalibration = 0.7;
constexpr double kMostCalibration = 3.0;

}  // namespace

void PictureHold::reset() {
  told_.clear();
  motions_.clear();
  picture_.reset();
  isHeld_ = true;
  quietMotion_ = glm::dmat3(1.0);
  quietFrames_ = 0;
  calibration_ = 1.0;
}

void PictureHold::match(std::span<const SeenFeature> seen) {
  next_.clear();
  auto known = told_.begin();
  for (const SeenFeature& feature : seen) {
    while (known != told_.end() && known->id < feature.id) ++known;
    const bool isKnown = known != told_.end() && known->id == feature.id;
    Told told{.id = feature.id, .px = feature.thenPx, .isHeld = isHeld_};
    if (isKnown && feature.wasSeen) told = *known;
    told.isNew = !feature.wasSeen;
    if (told.isNew) told.px = feature.px;
    told.agrees = false;
    told.errorPx = calibration_ * feature.errorPx;
    told.seenPx = feature.px;
    next_.push_back(told);
  }
  std::swap(told_, next_);
}

void PictureHold::holdPicture(const HomographyFit& fit, hal::FrameSize size, double scale) {
  const double moved = rmsMotion(fit.nowFromThen, size);
  const double bandPx = std::max(kBandPx * scale, kPictureErrors * fit.fitErrorPx);
  if (moved > bandPx) {
    isHeld_ = false;
    quietMotion_ = glm::dmat3(1.0);
    quietFrames_ = 0;
    picture_ = PictureHomography{
        .nowFromThen = fit.nowFromThen,
        .errorPx = std::hypot(fit.fitErrorPx, fit.modelErrorPx, kLeastErrorPx * scale)};
    return;
  }
  picture_ =
      PictureHomography{.nowFromThen = glm::dmat3(1.0),
                        .errorPx = std::hypot(moved, fit.modelErrorPx, kLeastErrorPx * scale)};
}

void PictureHold::releasePicture(const HomographyFit& fit, hal::FrameSize size, double scale) {
  picture_ = PictureHomography{
      .nowFromThen = fit.nowFromThen,
      .errorPx = std::hypot(fit.fitErrorPx, fit.modelErrorPx, kLeastErrorPx * scale)};
  quietMotion_ = fit.nowFromThen * quietMotion_;
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

/// Predictions go by white noise; that of a compressed movie is not. What they are off by shows in
/// the features that follow the picture best, even where it is no plane.
void PictureHold::calibrate(const HomographyFit& fit) {
  ratios_.clear();
  for (const PointPair& pair : pairs_) {
    const double off = glm::distance(movedBy(fit.nowFromThen, pair.then), pair.now);
    ratios_.push_back(off / pair.errorPx);
  }
  const auto quarter = ratios_.begin() + static_cast<std::ptrdiff_t>(ratios_.size() / 4);
  std::nth_element(ratios_.begin(), quarter, ratios_.end());
  // A quarter of normal deviations over two axes is less than this part of their RMS.
  constexpr double kQuarterOfNormal = 0.536;
  const double ratio = calibration_ * *quarter / kQuarterOfNormal;
  calibration_ += kCalibrationPace * (ratio - calibration_);
  calibration_ = std::clamp(calibration_, kLeastCalibration, kMostCalibration);
}

void PictureHold::movePicture(hal::FrameSize size, double scale) {
  // From where features were told to be: while the picture is held, of those that are held, too.
  pairs_.clear();
  pairOf_.clear();
  for (std::size_t i = 0; i < told_.size(); ++i) {
    const Told& told = told_[i];
    if (told.isNew || (isHeld_ && !told.isHeld)) continue;
    pairs_.push_back({.then = told.px, .now = told.seenPx, .errorPx = told.errorPx});
    pairOf_.push_back(i);
  }
  picture_.reset();
  isSettling_ = false;
  const auto fit = fitter_.fit(pairs_, size);
  if (!fit) return;
  for (std::size_t i = 0; i < pairs_.size(); ++i) told_[pairOf_[i]].agrees = fitter_.agrees(i);
  calibrate(*fit);
  if (isHeld_) {
    holdPicture(*fit, size, scale);
  } else {
    releasePicture(*fit, size, scale);
  }
}

void PictureHold::moveFeature(Told& told, double scale) {
  const double bandPx = std::max(kBandPx * scale, kFeatureErrors * told.errorPx);
  if (told.isHeld) {
    const double away = glm::distance(told.seenPx, told.px);
    told.beyondFrames = away > bandPx ? told.beyondFrames + 1 : 0;
    const bool goesAlong = told.agrees && !isHeld_;
    if (!goesAlong && told.beyondFrames < kFramesBeyond && away < kFarBeyond * bandPx) return;
    told.isHeld = false;
    told.quietFrames = 0;
    told.quietFrom = told.seenPx;
    told.beyondFrames = 0;
  } else if (glm::distance(told.seenPx, told.quietFrom) > bandPx) {
    told.quietFrom = told.seenPx;
    told.quietFrames = 0;
  } else if (++told.quietFrames >= kQuietFrames || (isSettling_ && told.agrees)) {
    told.isHeld = isHeld_ || !told.agrees;
  }
  told.px = told.seenPx;
}

void PictureHold::update(std::span<const SeenFeature> seen, hal::FrameSize size, double scale) {
  match(seen);
  movePicture(size, scale);
  motions_.clear();
  for (Told& told : told_) {
    const glm::dvec2 then = told.px;
    if (told.isNew) continue;
    moveFeature(told, scale);
    motions_.push_back({.id = told.id,
                        .then = glm::vec2(then),
                        .now = glm::vec2(told.px),
                        .errorPx = static_cast<float>(told.errorPx)});
  }
}

}  // namespace pleinair::tracking
