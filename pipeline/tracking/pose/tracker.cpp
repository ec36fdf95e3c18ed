#include "pipeline/tracking/pose/tracker.h"

#include <algorithm>
#include <cassert>
#include <chrono>
#include <utility>

#include <fmt/format.h>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "pipeline/tracking/pose/twist.h"

namespace pleinair::tracking {

TrackingCounters countedSince(const TrackingCounters& before, const TrackingCounters& now) {
  return {.detection = {.accepted = now.detection.accepted - before.detection.accepted,
                        .rejectedMargin =
                            now.detection.rejectedMargin - before.detection.rejectedMargin,
                        .rejectedDuplicate =
                            now.detection.rejectedDuplicate - before.detection.rejectedDuplicate,
                        .skippedSmallPicture = now.detection.skippedSmallPicture -
                                               before.detection.skippedSmallPicture},
          .unknownTags = now.unknownTags - before.unknownTags,
          .mirroredTags = now.mirroredTags - before.mirroredTags,
          .smallTags = now.smallTags - before.smallTags,
          .degenerateTags = now.degenerateTags - before.degenerateTags,
          .ambiguousTags = now.ambiguousTags - before.ambiguousTags,
          .contradictingTags = now.contradictingTags - before.contradictingTags};
}

std::array<Rejection, 8> rejections(const TrackingCounters& counters) {
  return {{{"faint", counters.detection.rejectedMargin},
           {"duplicate", counters.detection.rejectedDuplicate},
           {"unknown", counters.unknownTags},
           {"mirrored", counters.mirroredTags},
           {"small", counters.smallTags},
           {"degenerate", counters.degenerateTags},
           {"ambiguous", counters.ambiguousTags},
           {"contradicting", counters.contradictingTags}}};
}

namespace {

/// Least time between two key frames, unless something new is seen.
constexpr hal::Duration kKeyPeriod = std::chrono::milliseconds(60);

/// Time between two searches for mirrored tags while no tag is seen.
constexpr hal::Duration kMirrorPeriod = std::chrono::seconds(1);

/// The corners of a cube on a tag.
std::vector<glm::dvec3> cubeOn(double edgeMetres) {
  std::vector<glm::dvec3> points;
  for (const double height : {0.0, edgeMetres}) {
    for (const glm::dvec3& foot : tagCorners(edgeMetres)) {
      points.push_back(foot - glm::dvec3(0.0, 0.0, height));
    }
  }
  return points;
}

/// Projected corners of a tag; nothing where it is behind the camera or far beside the image, where
/// a lens model may fold it back.
std::optional<TagCornersPx> projectedCorners(const CameraModel& camera,
                                             const glm::dmat4& cameraFromTag, double edgeMetres) {
  const auto points = tagCorners(edgeMetres);
  const glm::dvec2 size(camera.imageSize().width, camera.imageSize().height);
  TagCornersPx corners{};
  for (std::size_t i = 0; i < points.size(); ++i) {
    const glm::dvec3 inCamera(cameraFromTag * glm::dvec4(points[i], 1.0));
    if (!(inCamera.z > 1e-3)) return std::nullopt;
    corners[i] = camera.project(inCamera);
    const glm::dvec2 outside = glm::abs(corners[i] - 0.5 * size) / size;
    if (!(std::max(outside.x, outside.y) < 1.0)) return std::nullopt;
  }
  return corners;
}

bool isInside(const TagCornersPx& corners, const CameraModel& camera) {
  return std::ranges::all_of(corners, [&](const glm::dvec2& px) {
    return px.x > 0.0 && px.y > 0.0 && px.x < camera.imageSize().width &&
           px.y < camera.imageSize().height;
  });
}

double shortestEdgePx(const TagCornersPx& corners) {
  double least = glm::distance(corners[3], corners[0]);
  for (std::size_t i = 0; i < 3; ++i) {
    least = std::min(least, glm::distance(corners[i], corners[i + 1]));
  }
  return least;
}

}  // namespace

hal::Result<void> checkSize(const CameraModel& camera, hal::FrameSize frame,
                            std::string calibration) {
  const hal::FrameSize size = camera.imageSize();
  if (size == frame) return {};
  return tl::unexpected(
      hal::Error{.kind = hal::ErrorKind::kInvalidInput,
                 .subject = std::move(calibration),
                 .problem = fmt::format("the calibration is for {}x{} px, the frames have {}x{}",
                                        size.width, size.height, frame.width, frame.height),
                 .remedy = "calibrate the camera at the size that it delivers"});
}

Tracker::Tracker(std::optional<CameraModel> camera, std::vector<TagMarker> markers,
                 TrackerOptions options)
    : camera_(camera),
      markers_(std::move(markers)),
      options_(std::move(options)),
      detector_(options_.detector),
      world_{.pose = TargetPose(options_.poses)},
      targets_(markers_.size(), Target{.pose = TargetPose(options_.poses)}),
      isWithWorld_(markers_.size()),
      isSeen_(markers_.size()) {
  for (const TagMarker& marker : markers_) {
    models_.push_back(cubeOn(marker.edgeMetres));
    if (!marker.worldFromTag) continue;
    worldPlanes_.push_back(
        {.targetFromTag = *marker.worldFromTag, .edgeMetres = marker.edgeMetres});
    for (const glm::dvec3& point : models_.back()) {
      worldModel_.emplace_back(*marker.worldFromTag * glm::dvec4(point, 1.0));
    }
  }
}

void Tracker::reset() {
  world_.pose.reset();
  for (Target& target : targets_) target.pose.reset();
  std::ranges::fill(isWithWorld_, std::uint8_t{0});
  features_.reset();
  tags_.clear();
  expected_.clear();
  lastFullSearch_.reset();
  searchedMirrored_.reset();
}

TrackingResult Tracker::track(const hal::ImageView& image, hal::TimePoint captureTime) {
  own_.take(image);
  return track(own_, captureTime);
}

TrackingResult Tracker::track(LumaFrame& frame, hal::TimePoint captureTime) {
  assert(!camera_ || camera_->imageSize() == frame.size());
  const TrackingCounters before = counters_;
  if (camera_) predict(frame, captureTime);
  findTags(frame.luma(), frame.size(), captureTime);
  TrackingResult result;
  if (camera_) {
    findSightings();
    solveWorld(captureTime);
    for (const Sighting& sighting : sightings_) solveTag(sighting, captureTime);
    missTags(captureTime);
    keepKeyFrame(captureTime);
    publishTags(captureTime);
    publishWorld(captureTime, result);
  }
  result.tags = tags_;
  result.counted = countedSince(before, counters_);
  return result;
}

/// Follows features into this frame and predicts all known poses with them.
void Tracker::predict(LumaFrame& frame, hal::TimePoint now) {
  if (markers_.empty()) return;
  if (options_.poses.filters || options_.poses.carries) features_.follow(frame.pyramid());
  world_.pose.predict(*camera_, features_.tracks(), now);
  for (Target& target : targets_) target.pose.predict(*camera_, features_.tracks(), now);
  expectTags(now);
}

/// Expected positions of tags from before this frame: predicted ones for tags of the scene, the
/// last ones for others.
void Tracker::expectTags(hal::TimePoint now) {
  expected_.clear();
  for (const TrackedTag& tag : tags_) {
    if (!tag.cameraFromTag) expected_.push_back({.id = tag.id, .corners = tag.corners});
  }
  for (std::size_t i = 0; i < markers_.size(); ++i) {
    std::optional<PoseEstimate> pose = drawnTag(i, now);
    if (!pose) pose = worldTag(i, now);
    if (!pose) continue;
    const auto corners = projectedCorners(*camera_, pose->cameraFromTarget, markers_[i].edgeMetres);
    if (corners) expected_.push_back({.id = markers_[i].id, .corners = *corners});
  }
}

void Tracker::findTags(const hal::PlaneView& luma, hal::FrameSize size, hal::TimePoint now) {
  if (!needsSearch(now)) {
    takeTags(detector_.detectExpected(luma, size, counters_.detection, expected_));
    if (!tags_.empty()) return;
  }
  lastFullSearch_ = now;
  takeTags(detector_.detect(luma, size, counters_.detection, expected_));
  if (tags_.empty()) searchMirrored(luma, size, now);
}

/// A camera that mirrors its image shows no readable tag. After each second without tags, searches
/// the mirrored image, so that the counters can report it.
void Tracker::searchMirrored(const hal::PlaneView& luma, hal::FrameSize size, hal::TimePoint now) {
  if (markers_.empty() || std::min(size.width, size.height) < kSmallestSearchedSidePx) return;
  const bool isEarly =
      searchedMirrored_ && now >= *searchedMirrored_ && now - *searchedMirrored_ < kMirrorPeriod;
  if (isEarly) return;
  searchedMirrored_ = now;
  const auto width = static_cast<std::size_t>(size.width);
  mirrored_.resize(width * static_cast<std::size_t>(size.height));
  for (std::size_t y = 0; y < static_cast<std::size_t>(size.height); ++y) {
    std::ranges::reverse_copy(luma.bytes.subspan(y * luma.strideBytes, width),
                              mirrored_.begin() + static_cast<std::ptrdiff_t>(y * width));
  }
  DetectionCounters uncounted;
  const hal::PlaneView plane{.bytes = mirrored_, .strideBytes = width};
  for (const TagDetection& tag : detector_.detect(plane, size, uncounted)) {
    if (std::ranges::find(markers_, tag.id, &TagMarker::id) != markers_.end()) {
      ++counters_.mirroredTags;
    }
  }
}

/// Whether to search the whole image: nothing is known, a tag is missing, or the period is over.
bool Tracker::needsSearch(hal::TimePoint now) const {
  if (expected_.empty() || !lastFullSearch_ || now <= *lastFullSearch_) return true;
  return now - *lastFullSearch_ >= (isMissing_ ? options_.searchPeriod / 2 : options_.searchPeriod);
}

void Tracker::takeTags(std::span<const TagDetection> detections) {
  tags_.clear();
  for (const TagDetection& detection : detections) {
    tags_.push_back({.id = detection.id, .corners = detection.corners});
  }
  isMissing_ = std::ranges::any_of(expected_, [&](const ExpectedTag& tag) {
    return std::ranges::find(tags_, tag.id, &TrackedTag::id) == tags_.end() &&
           isInside(tag.corners, *camera_);
  });
}

void Tracker::findSightings() {
  sightings_.clear();
  std::ranges::fill(isSeen_, std::uint8_t{0});
  for (std::size_t i = 0; i < tags_.size(); ++i) {
    const auto marker = std::ranges::find(markers_, tags_[i].id, &TagMarker::id);
    if (marker == markers_.end()) {
      ++counters_.unknownTags;
      continue;
    }
    if (shortestEdgePx(tags_[i].corners) < options_.minEdgePx) {
      ++counters_.smallTags;
      continue;
    }
    const PoseCandidates candidates =
        tagPoseCandidates(*camera_, tags_[i].corners, marker->edgeMetres);
    if (candidates.empty()) {
      ++counters_.degenerateTags;
      continue;
    }
    const auto index = static_cast<std::size_t>(marker - markers_.begin());
    isSeen_[index] = 1;
    sightings_.push_back({.marker = index, .tag = i, .candidates = candidates});
  }
}

void Tracker::solveWorld(hal::TimePoint now) {
  worldTags_.clear();
  worldTagSighting_.clear();
  for (std::size_t i = 0; i < sightings_.size(); ++i) {
    const TagMarker& marker = markers_[sightings_[i].marker];
    if (!marker.worldFromTag) continue;
    worldTags_.push_back({.worldFromTag = *marker.worldFromTag,
                          .edgeMetres = marker.edgeMetres,
                          .corners = tags_[sightings_[i].tag].corners,
                          .candidates = sightings_[i].candidates});
    worldTagSighting_.push_back(i);
  }
  const std::optional<WorldPose> pose = worldSolver_.solve(*camera_, worldTags_, prior(world_));
  if (!pose) return world_.pose.miss(now);
  world_.pose.see(*camera_, features_.tracks(), pose->estimate, worldModel_, now);
  world_.ambiguityEvidence = pose->ambiguityEvidence;
  for (std::size_t i = 0; i < worldTagSighting_.size(); ++i) {
    Sighting& sighting = sightings_[worldTagSighting_[i]];
    sighting.agrees = pose->agrees[i] != 0;
    if (!sighting.agrees) ++counters_.contradictingTags;
    tags_[sighting.tag].choice = pose->choice;
  }
}

void Tracker::solveTag(const Sighting& sighting, hal::TimePoint now) {
  TrackedTag& tag = tags_[sighting.tag];
  Target& target = targets_[sighting.marker];
  isWithWorld_[sighting.marker] = sighting.agrees ? 1 : 0;
  if (sighting.agrees) {
    target.pose.reset();
  } else {
    const std::optional<TagPose> pose = chooseTagPose(sighting.candidates, prior(target));
    target.pose.see(*camera_, features_.tracks(), pose->estimate, models_[sighting.marker], now);
    target.ambiguityEvidence = pose->ambiguityEvidence;
    tag.choice = pose->choice;
  }
  if (tag.choice == AmbiguityResolution::kAmbiguous) ++counters_.ambiguousTags;
}

void Tracker::missTags(hal::TimePoint now) {
  for (std::size_t i = 0; i < markers_.size(); ++i) {
    if (isSeen_[i] == 0) targets_[i].pose.miss(now);
  }
}

/// Makes this frame the features' key frame where the old one shares too little with it, or where a
/// target was seen for the first time.
void Tracker::keepKeyFrame(hal::TimePoint now) {
  if (markers_.empty() || !(options_.poses.filters || options_.poses.carries)) return;
  bool isNew = world_.pose.needsLandmarks();
  for (const Target& target : targets_) isNew = isNew || target.pose.needsLandmarks();
  if (!isNew && !(now - keyMade_ >= kKeyPeriod && features_.isKeyStale())) return;
  keyMade_ = now;
  keyTags_.clear();
  for (const TrackedTag& tag : tags_) keyTags_.push_back(tag.corners);
  features_.makeKey(keyTags_);
  world_.pose.anchor(*camera_, features_.tracks(), worldPlanes_);
  for (std::size_t i = 0; i < markers_.size(); ++i) {
    findPlanes(i);
    targets_[i].pose.anchor(*camera_, features_.tracks(), planes_);
  }
}

/// Collects a tag's own plane, and those of the other tags if they stand still together.
void Tracker::findPlanes(std::size_t marker) {
  planes_.clear();
  const std::optional<PoseEstimate> own = targets_[marker].pose.predicted();
  if (!own) return;
  planes_.push_back({.targetFromTag = glm::dmat4(1.0), .edgeMetres = markers_[marker].edgeMetres});
  const glm::dmat4 tagFromCamera = rigidInverse(own->cameraFromTarget);
  for (std::size_t i = 0; i < markers_.size(); ++i) {
    const std::optional<PoseEstimate> other = targets_[i].pose.predicted();
    if (i == marker || !other || targets_[i].pose.movesAlone()) continue;
    planes_.push_back({.targetFromTag = tagFromCamera * other->cameraFromTarget,
                       .edgeMetres = markers_[i].edgeMetres});
  }
}

/// Pose of a marker to draw with: from the world, or its own.
std::optional<PoseEstimate> Tracker::drawnTag(std::size_t marker, hal::TimePoint now) const {
  return isWithWorld_[marker] != 0 ? worldTag(marker, now) : targets_[marker].pose.drawn(now);
}

/// Pose of a marker as its place in the world gives it.
std::optional<PoseEstimate> Tracker::worldTag(std::size_t marker, hal::TimePoint now) const {
  if (!markers_[marker].worldFromTag) return std::nullopt;
  std::optional<PoseEstimate> pose = world_.pose.drawn(now);
  if (!pose) return pose;
  const glm::dmat4& worldFromTag = *markers_[marker].worldFromTag;
  const glm::dvec3 arm = glm::dmat3(pose->cameraFromTarget) * glm::dvec3(worldFromTag[3]);
  pose->covariance = atPoint(pose->covariance, arm);
  pose->cameraFromTarget = pose->cameraFromTarget * worldFromTag;
  return pose;
}

void Tracker::publishTags(hal::TimePoint now) {
  for (const Sighting& sighting : sightings_) {
    const std::optional<PoseEstimate> pose = drawnTag(sighting.marker, now);
    tags_[sighting.tag].cameraFromTag = pose->cameraFromTarget;
    tags_[sighting.tag].covariance = pose->covariance;
  }
  for (std::size_t i = 0; i < markers_.size(); ++i) publishCarried(i, now);
  std::ranges::sort(tags_, {}, &TrackedTag::id);
}

void Tracker::publishCarried(std::size_t marker, hal::TimePoint now) {
  if (isSeen_[marker] != 0 || !options_.poses.carries) return;
  const std::optional<PoseEstimate> pose = drawnTag(marker, now);
  if (!pose) return;
  const auto corners =
      projectedCorners(*camera_, pose->cameraFromTarget, markers_[marker].edgeMetres);
  if (!corners) return;
  std::erase_if(tags_, [&](const TrackedTag& tag) { return tag.id == markers_[marker].id; });
  tags_.push_back({.id = markers_[marker].id,
                   .corners = *corners,
                   .cameraFromTag = pose->cameraFromTarget,
                   .covariance = pose->covariance,
                   .choice = AmbiguityResolution::kByPrior,
                   .source = PoseSource::kCarried});
}

void Tracker::publishWorld(hal::TimePoint now, TrackingResult& result) const {
  const std::optional<PoseEstimate> pose = world_.pose.drawn(now);
  if (!pose) return;
  result.cameraFromWorld = pose->cameraFromTarget;
  result.worldCovariance = pose->covariance;
  result.worldSource = world_.pose.source();
  result.worldRmsPx = pose->rmsPx;
  result.worldRotationSigmaRad = pose->rotationSigmaRad();
  result.worldTranslationSigmaMetres = pose->translationSigmaMetres();
}

std::optional<PosePrior> Tracker::prior(const Target& target) {
  const std::optional<PoseEstimate> predicted = target.pose.predicted();
  if (!predicted) return std::nullopt;
  return PosePrior{.cameraFromTarget = predicted->cameraFromTarget,
                   .evidence = target.ambiguityEvidence};
}

}  // namespace pleinair::tracking
