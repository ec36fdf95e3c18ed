#include "pipeline/tracking/pose/target_pose.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <glm/geometric.hpp>

namespace pleinair::tracking {
namespace {

/// A feature's noise in images up to 640 px wide; wider ones are reduced to follow features.
constexpr double kFeatureNoisePx = 0.12;
constexpr double kFollowedSidePx = 640.0;
/// The part of a sighting's variance that all sightings from one position share, so that no filter
/// averages it away: the effect of edges, lens and pixels on a corner (docs/measured.md).
constexpr double kShared = 0.15;
/// A sighting further than this from the prediction, in sigmas and px, casts doubt on it.
constexpr double kDoubtSigmas = 3.0;
constexpr double kDoubtPx = 0.5;
/// After this many doubts in a row the target does not move with the features around it.
constexpr int kMaxDoubts = 4;
constexpr auto kAloneFor = std::chrono::seconds(2);
/// Rate at which the mean difference follows new ones, and its largest expected distance from zero,
/// in sigmas of one (by chance: a third of one).
constexpr double kBiasRate = 0.2;
constexpr double kBiasSigmas = 0.4;
/// Jumps larger than this part of the image are cuts and not blended.
constexpr double kMaxBlendedJump = 0.1;
/// Without features: the part of a velocity left after a second, and its standard deviation.
constexpr double kVelocityKept = 1e-4;
constexpr double kGuessPx = 3.0;

double rmsDistancePx(const CameraModel& camera, const glm::dmat4& a, const glm::dmat4& b,
                     std::span<const glm::dvec3> points) {
  double sum = 0.0;
  for (const glm::dvec3& point : points) {
    const glm::dvec3 first(a * glm::dvec4(point, 1.0));
    const glm::dvec3 second(b * glm::dvec4(point, 1.0));
    if (!(first.z > 1e-3) || !(second.z > 1e-3)) return std::numeric_limits<double>::infinity();
    const glm::dvec2 apart = camera.project(first) - camera.project(second);
    sum += glm::dot(apart, apart);
  }
  return std::sqrt(sum / static_cast<double>(points.size()));
}

double longSidePx(const CameraModel& camera) {
  return std::max(camera.imageSize().width, camera.imageSize().height);
}

}  // namespace

void TargetPose::reset() {
  isKnown_ = false;
  isAnchored_ = false;
  movesAlone_ = false;
  doubts_ = 0;
  velocity_ = {};
  offset_ = {};
  bias_ = {};
  landmarks_.clear();
}

double TargetPose::noisePx(const CameraModel& camera) const {
  return kFeatureNoisePx * std::max(1.0, longSidePx(camera) / kFollowedSidePx);
}

std::optional<PoseEstimate> TargetPose::predicted() const {
  if (!isKnown_) return std::nullopt;
  return PoseEstimate{.cameraFromTarget = filter_.cameraFromTarget(),
                      .rmsPx = rmsPx_,
                      .covariance = filter_.covariance()};
}

void TargetPose::predict(const CameraModel& camera, std::span<const FeatureTrack> tracks,
                         hal::TimePoint now) {
  if (!isKnown_) return;
  if (now - seen_ > options_.carryFor || now <= last_) return reset();
  if (!options_.filters && !options_.carries) return;
  before_ = filter_.cameraFromTarget();
  const double step = hal::toSeconds(now - last_);
  const auto moved = landmarks_.solve(camera, tracks, before_, keyFromTarget_, noisePx(camera));
  if (moved) {
    moveByFeatures(*moved);
  } else {
    extrapolate(camera, step);
  }
  velocity_ = (1.0 / step) * motionBetween(before_, filter_.cameraFromTarget());
  last_ = now;
}

void TargetPose::moveByFeatures(const LandmarkPose& moved) {
  filter_.predict(moved.estimate.cameraFromTarget, moved.estimate.covariance);
  cameraFromKey_ = moved.estimate.cameraFromTarget * rigidInverse(keyFromTarget_);
  rmsPx_ = moved.estimate.rmsPx;
}

/// Continues the last motion, ever slower.
void TargetPose::extrapolate(const CameraModel& camera, double step) {
  const double kept = std::pow(kVelocityKept, step);
  const glm::dmat4 guess = movedBy(filter_.cameraFromTarget(), (kept * step) * velocity_);
  const double distance = std::max(0.01, guess[3].z);
  const double shift =
      kGuessPx * distance / camera.intrinsics().fx + 0.5 * step * glm::length(velocity_.shift);
  const double turn =
      kGuessPx / camera.intrinsics().fx + 0.5 * step * glm::length(velocity_.rotation);
  filter_.predict(guess, isotropic(turn, shift));
  cameraFromKey_ = guess * rigidInverse(keyFromTarget_);
}

void TargetPose::see(const CameraModel& camera, std::span<const FeatureTrack> tracks,
                     const PoseEstimate& seen, std::span<const glm::dvec3> modelPoints,
                     hal::TimePoint now) {
  const bool wasKnown = isKnown_;
  const bool wasCarried = wasKnown && source_ == PoseSource::kCarried;
  const std::optional<PoseEstimate> drawnBefore = wasCarried ? drawn(now) : std::nullopt;
  seen_ = now;
  last_ = now;
  source_ = PoseSource::kSeen;
  rmsPx_ = seen.rmsPx;
  shared_ = kShared * seen.covariance;
  isKnown_ = true;
  if (!wasKnown || !options_.filters) {
    filter_.start(seen);
    if (!wasKnown) offset_ = {};
  } else {
    correct(camera, seen, modelPoints, now);
  }
  keyFromTarget_ = rigidInverse(cameraFromKey_) * filter_.cameraFromTarget();
  if (options_.filters) {
    landmarks_.learn(camera, tracks, filter_.cameraFromTarget(), keyFromTarget_, noisePx(camera));
  }
  if (drawnBefore) {
    const double jump = rmsDistancePx(camera, filter_.cameraFromTarget(),
                                      drawnBefore->cameraFromTarget, modelPoints);
    const bool isCut = !(jump < kMaxBlendedJump * longSidePx(camera));
    offset_ =
        isCut ? Twist{} : motionBetween(filter_.cameraFromTarget(), drawnBefore->cameraFromTarget);
    blendFrom_ = now;
  }
}

/// Sightings count more the more of them, now or recently, lie on one side of the prediction.
void TargetPose::correct(const CameraModel& camera, const PoseEstimate& seen,
                         std::span<const glm::dvec3> modelPoints, hal::TimePoint now) {
  const glm::dmat4 predicted = filter_.cameraFromTarget();
  const double apart = rmsDistancePx(camera, predicted, seen.cameraFromTarget, modelPoints);
  if (!std::isfinite(apart)) return filter_.start(seen);
  const double expected = std::sqrt(
      projectedVariancePx(camera, predicted, filter_.covariance() + seen.covariance, modelPoints));
  bias_ = (1.0 - kBiasRate) * bias_ + kBiasRate * motionBetween(predicted, seen.cameraFromTarget);
  const double bias = rmsDistancePx(camera, predicted, movedBy(predicted, bias_), modelPoints);

  const bool isDoubtful = apart > std::max(kDoubtPx, kDoubtSigmas * expected);
  const double byBias = bias / (kBiasSigmas * expected);
  if (!std::isfinite(byBias)) {  // beyond the camera: no earlier estimate holds
    bias_ = {};
    return filter_.start(seen);
  }
  filter_.correct(seen, std::max({1.0, byBias, isDoubtful ? 2.0 * apart / expected : 0.0}));
  const double left =
      rmsDistancePx(camera, filter_.cameraFromTarget(), seen.cameraFromTarget, modelPoints);
  if (apart > 0.0) bias_ = std::min(1.0, left / apart) * bias_;

  doubts_ = isDoubtful ? doubts_ + 1 : 0;
  if (doubts_ >= kMaxDoubts) {
    // Anchor again, with landmarks on the target's tags only.
    if (!movesAlone_) isAnchored_ = false;
    movesAlone_ = true;
    movedAlone_ = now;
  } else if (movesAlone_ && now - movedAlone_ > kAloneFor) {
    movesAlone_ = false;
  }
}

void TargetPose::miss(hal::TimePoint now) {
  if (!isKnown_) return;
  if (!options_.carries || now - seen_ > options_.carryFor) return reset();
  source_ = PoseSource::kCarried;
  doubts_ = 0;
}

void TargetPose::anchor(const CameraModel& camera, std::span<const FeatureTrack> tracks,
                        std::span<const TagPlane> planes) {
  if (!isKnown_) return landmarks_.clear();
  isAnchored_ = true;
  const glm::dmat4 keyFromTarget = filter_.cameraFromTarget();
  landmarks_.anchor(camera, tracks, keyFromTarget, keyFromTarget_, planes, movesAlone_);
  keyFromTarget_ = keyFromTarget;
  cameraFromKey_ = glm::dmat4(1.0);
}

/// Falls smoothly from one to zero.
double TargetPose::blendWeight(hal::TimePoint now) const {
  const double over = hal::toSeconds(options_.blendOver);
  const double t = over > 0.0 ? std::clamp(hal::toSeconds(now - blendFrom_) / over, 0.0, 1.0) : 1.0;
  return 1.0 - t * t * (3.0 - 2.0 * t);
}

std::optional<PoseEstimate> TargetPose::drawn(hal::TimePoint now) const {
  std::optional<PoseEstimate> out = predicted();
  if (!out) return out;
  const Twist offset = blendWeight(now) * offset_;
  out->cameraFromTarget = movedBy(out->cameraFromTarget, offset);
  out->covariance = out->covariance + shared_ +
                    isotropic(glm::length(offset.rotation), glm::length(offset.shift));
  return out;
}

}  // namespace pleinair::tracking
