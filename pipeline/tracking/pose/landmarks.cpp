#include "pipeline/tracking/pose/landmarks.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <glm/geometric.hpp>
#include <glm/mat2x2.hpp>

#include "hal/median.h"
#include "pipeline/tracking/pose/twist.h"

namespace pleinair::tracking {
namespace {

/// Extent of a tag's white paper, in halves of its edge: printed tags have a margin of at least one
/// cell of ten.
constexpr double kPaper = 1.2;
/// Largest distance of a feature from its tag, in halves of the edge.
constexpr double kReach = 24.0;
/// Standard deviation of the relative inverse depth on a tag, and its growth per half edge of
/// distance.
constexpr double kSigmaOnTag = 0.002;
constexpr double kSigmaByDistance = 0.1;
constexpr double kMaxSigma = 0.5;
/// A ray that meets a plane below this sine is not intersected.
constexpr double kGrazing = 0.08;
constexpr std::size_t kMinUsed = 6;
constexpr double kMinShare = 0.5;
constexpr double kFirstHuberPx = 3.0;
constexpr double kAgreeSigmas = 5.0;
constexpr double kMinAgreementPx = 1.0;
constexpr int kMaxContradictions = 5;
/// Errors of one feature in neighbouring frames are correlated: each counts as less than one.
constexpr double kLearnNoise = 4.0;

/// Scales errors along `byDepth` (px for one sigma of depth) down to their share in the total
/// noise.
glm::dmat2 whiteningOf(const glm::dvec2& byDepth, double noisePx) {
  const double length = glm::length(byDepth);
  if (length < 1e-9) return glm::dmat2(1.0);
  const glm::dvec2 along = byDepth / length;
  const double ratio = length / noisePx;
  const double less = 1.0 - 1.0 / std::sqrt(1.0 + ratio * ratio);
  return glm::dmat2(1.0) - less * glm::outerProduct(along, along);
}

}  // namespace

std::optional<double> Landmarks::planeInverseDepth(const Landmark& landmark,
                                                   const glm::dmat4& keyFromTarget) const {
  const glm::dmat4 keyFromTag = keyFromTarget * planes_[landmark.plane].targetFromTag;
  const glm::dvec3 normal(keyFromTag[2]);
  const double along = glm::dot(normal, landmark.ray);
  const double distance = glm::dot(normal, glm::dvec3(keyFromTag[3]));
  if (std::abs(along) < kGrazing * glm::length(landmark.ray)) return std::nullopt;
  const double inverse = along / distance;
  if (!(inverse > 0.0) || !std::isfinite(inverse)) return std::nullopt;
  return inverse;
}

std::optional<glm::dvec3> Landmarks::place(const Landmark& landmark,
                                           const glm::dmat4& keyFromTarget) const {
  const auto plane = planeInverseDepth(landmark, keyFromTarget);
  if (!plane) return std::nullopt;
  const double inverse = *plane * (1.0 + landmark.correction);
  if (!(inverse > 0.0)) return std::nullopt;
  return landmark.ray / inverse;
}

/// Places a track on the plane of its nearest tag; distances in that tag's sizes.
std::optional<Landmarks::Landmark> Landmarks::placed(const CameraModel& camera,
                                                     const FeatureTrack& track,
                                                     const glm::dmat4& keyFromTarget,
                                                     bool onTagsOnly) const {
  const std::optional<glm::dvec3> ray = camera.unproject(track.keyPx);
  if (!ray) return std::nullopt;
  Landmark best{.id = track.id, .ray = *ray};
  double nearest = onTagsOnly ? kPaper : kReach;
  bool isPlaced = false;
  for (std::size_t plane = 0; plane < planes_.size(); ++plane) {
    Landmark candidate = best;
    candidate.plane = plane;
    candidate.correction = 0.0;
    const auto at = place(candidate, keyFromTarget);
    if (!at) continue;
    const glm::dmat4 tagFromKey = rigidInverse(keyFromTarget * planes_[plane].targetFromTag);
    const glm::dvec3 onTag = transform(tagFromKey, *at) * (2.0 / planes_[plane].edgeMetres);
    const double distance = std::max(std::abs(onTag.x), std::abs(onTag.y));
    if (distance >= nearest) continue;
    nearest = distance;
    best.plane = plane;
    isPlaced = true;
  }
  if (!isPlaced) return std::nullopt;
  best.sigma = std::clamp(kSigmaByDistance * (nearest - kPaper), kSigmaOnTag, kMaxSigma);
  return best;
}

/// Reserves all memory that later frames may need.
void Landmarks::reserve() {
  landmarks_.reserve(kMaxTracks);
  next_.reserve(kMaxTracks);
  places_.reserve(kMaxTracks);
  points_.reserve(kMaxTracks);
  errors_.reserve(kMaxTracks);
}

void Landmarks::anchor(const CameraModel& camera, std::span<const FeatureTrack> tracks,
                       const glm::dmat4& keyFromTarget, const glm::dmat4& oldKeyFromTarget,
                       std::span<const TagPlane> planes, bool onTagsOnly) {
  reserve();
  places_.clear();
  const glm::dmat4 targetFromOldKey = rigidInverse(oldKeyFromTarget);
  for (const Landmark& landmark : landmarks_) {
    places_.push_back(place(landmark, oldKeyFromTarget));
    if (places_.back()) places_.back() = transform(targetFromOldKey, *places_.back());
  }
  planes_.assign(planes.begin(), planes.end());
  next_.clear();
  for (const FeatureTrack& track : tracks) {
    std::optional<Landmark> landmark = placed(camera, track, keyFromTarget, onTagsOnly);
    if (!landmark) continue;
    const auto old = std::ranges::lower_bound(landmarks_, track.id, {}, &Landmark::id);
    if (old != landmarks_.end() && old->id == track.id) {
      const auto& was = places_[static_cast<std::size_t>(old - landmarks_.begin())];
      if (was) carryOver(*landmark, *old, transform(keyFromTarget, *was).z, keyFromTarget);
    }
    next_.push_back(*landmark);
  }
  landmarks_.swap(next_);
}

/// Carries a landmark's depth, and the correction learnt for it, from one key frame to the next.
void Landmarks::carryOver(Landmark& landmark, const Landmark& old, double depth,
                          const glm::dmat4& keyFromTarget) const {
  const auto plane = planeInverseDepth(landmark, keyFromTarget);
  if (!plane || !(depth > 0.0)) return;
  landmark.correction = 1.0 / (depth * *plane) - 1.0;
  landmark.sigma = old.sigma * (1.0 + landmark.correction) / (1.0 + old.correction);
  landmark.contradictions = old.contradictions;
}

/// Collects the found landmarks as points of the target.
void Landmarks::collect(const CameraModel& camera, std::span<const FeatureTrack> tracks,
                        const glm::dmat4& cameraFromTarget, const glm::dmat4& keyFromTarget,
                        double noisePx) {
  points_.clear();
  const glm::dmat4 targetFromKey = rigidInverse(keyFromTarget);
  const glm::dmat4 cameraFromKey = cameraFromTarget * targetFromKey;
  auto landmark = landmarks_.begin();
  for (const FeatureTrack& track : tracks) {
    while (landmark != landmarks_.end() && landmark->id < track.id) ++landmark;
    if (landmark == landmarks_.end()) break;
    if (landmark->id != track.id || !track.isFound) continue;
    const auto inKey = place(*landmark, keyFromTarget);
    if (!inKey) continue;
    const glm::dvec3 inCamera = transform(cameraFromKey, *inKey);
    if (!(inCamera.z > 1e-3)) continue;
    // One sigma of the inverse depth moves the point this far along its ray.
    const glm::dvec3 bySigma = glm::dmat3(cameraFromKey) * (*inKey * -landmark->sigma);
    const glm::dvec2 byDepth = camera.projectWithJacobian(inCamera).pxByCameraPoint * bySigma;
    points_.push_back({.target = transform(targetFromKey, *inKey),
                       .px = track.px,
                       .whitening = whiteningOf(byDepth, noisePx)});
  }
}

/// Keeps only the points that agree with a pose; returns their number.
std::size_t Landmarks::keepAgreeing(const CameraModel& camera, const glm::dmat4& cameraFromTarget,
                                    double noisePx) {
  const auto errorOf = [&](const Correspondence& point) {
    const glm::dvec3 inCamera = transform(cameraFromTarget, point.target);
    if (!(inCamera.z > 1e-3)) return std::numeric_limits<double>::infinity();
    return glm::length(point.whitening * (camera.project(inCamera) - point.px));
  };
  errors_.clear();
  for (const Correspondence& point : points_) errors_.push_back(errorOf(point));
  const double median = hal::medianOf(errors_);
  const double most = std::max({kMinAgreementPx, kAgreeSigmas * noisePx, 3.0 * median});
  std::erase_if(points_, [&](const Correspondence& point) { return errorOf(point) > most; });
  return points_.size();
}

std::optional<LandmarkPose> Landmarks::solve(const CameraModel& camera,
                                             std::span<const FeatureTrack> tracks,
                                             const glm::dmat4& start,
                                             const glm::dmat4& keyFromTarget, double noisePx) {
  collect(camera, tracks, start, keyFromTarget, noisePx);
  const std::size_t found = points_.size();
  if (found < kMinUsed) return std::nullopt;
  const auto first = refinePose(camera, points_, start, kFirstHuberPx);
  if (!first) return std::nullopt;
  // Whitening was computed for the target's earlier position: repeat for this one.
  collect(camera, tracks, first->cameraFromTarget, keyFromTarget, noisePx);
  const std::size_t used = keepAgreeing(camera, first->cameraFromTarget, noisePx);
  const double share = static_cast<double>(used) / static_cast<double>(found);
  if (used < kMinUsed || share < kMinShare) return std::nullopt;
  const auto second = refinePose(camera, points_, first->cameraFromTarget, 4.0 * noisePx);
  if (!second) return std::nullopt;
  return LandmarkPose{.estimate = *second, .used = used, .usedShare = share};
}

void Landmarks::learn(const CameraModel& camera, std::span<const FeatureTrack> tracks,
                      const glm::dmat4& cameraFromTarget, const glm::dmat4& keyFromTarget,
                      double noisePx) {
  const glm::dmat4 cameraFromKey = cameraFromTarget * rigidInverse(keyFromTarget);
  const double noise = kLearnNoise * noisePx;
  for (const FeatureTrack& track : tracks) {
    if (!track.isFound) continue;
    const auto landmark = std::ranges::lower_bound(landmarks_, track.id, {}, &Landmark::id);
    if (landmark == landmarks_.end() || landmark->id != track.id) continue;
    const auto inKey = place(*landmark, keyFromTarget);
    if (!inKey) continue;
    const glm::dvec3 inCamera = transform(cameraFromKey, *inKey);
    if (!(inCamera.z > 1e-3)) continue;
    const Projection shown = camera.projectWithJacobian(inCamera);
    const glm::dvec2 error = track.px - shown.px;
    // With `correction` the inverse depth grows in proportion, and the point comes nearer.
    const double share = 1.0 / (1.0 + landmark->correction);
    const glm::dvec2 by = shown.pxByCameraPoint * (glm::dmat3(cameraFromKey) * (*inKey * -share));
    const double predicted = glm::dot(by, by) * landmark->sigma * landmark->sigma;
    if (glm::length(whiteningOf(by * landmark->sigma, noisePx) * error) >
        std::max(kMinAgreementPx, kAgreeSigmas * noisePx)) {
      ++landmark->contradictions;
      continue;
    }
    landmark->contradictions = std::max(0, landmark->contradictions - 1);
    if (predicted < 0.01 * noise * noise) continue;  // hardly any parallax
    const double gain = landmark->sigma * landmark->sigma / (predicted + noise * noise);
    landmark->correction += gain * glm::dot(by, error);
    landmark->sigma *= std::sqrt(std::max(0.0, 1.0 - gain * glm::dot(by, by)));
    landmark->sigma = std::max(landmark->sigma, kSigmaOnTag);
  }
  std::erase_if(landmarks_, [](const Landmark& landmark) {
    return landmark.contradictions >= kMaxContradictions;
  });
}

}  // namespace pleinair::tracking
