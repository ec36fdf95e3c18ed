#include "pipeline/tracking/tracker.h"

#include <algorithm>
#include <cassert>
#include <utility>

#include <fmt/format.h>

namespace pleinair::tracking {

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
      remembered_(markers_.size()) {}

void Tracker::reset() {
  world_.reset();
  std::ranges::fill(remembered_, std::nullopt);
}

TrackingResult Tracker::track(const hal::ImageView& image, hal::TimePoint captureTime) {
  assert(!camera_ || camera_->imageSize() == image.format.size);
  tags_.clear();
  for (const TagDetection& detection :
       detector_.detect(luma_.convert(image), image.format.size, counters_.detection)) {
    tags_.push_back({.id = detection.id, .corners = detection.corners});
  }
  TrackingResult result{.tags = tags_};
  if (!camera_) return result;
  findSightings();
  solveWorld(captureTime, result);
  for (const Sighting& sighting : sightings_) solveTag(sighting, captureTime, result);
  return result;
}

void Tracker::findSightings() {
  sightings_.clear();
  for (std::size_t i = 0; i < tags_.size(); ++i) {
    const auto marker = std::ranges::find(markers_, tags_[i].id, &TagMarker::id);
    if (marker == markers_.end()) continue;
    const PoseCandidates candidates =
        tagPoseCandidates(*camera_, tags_[i].corners, marker->edgeMetres);
    if (candidates.empty()) {
      ++counters_.degenerateTags;
      continue;
    }
    sightings_.push_back({.marker = static_cast<std::size_t>(marker - markers_.begin()),
                          .tag = i,
                          .candidates = candidates});
  }
}

void Tracker::solveWorld(hal::TimePoint now, TrackingResult& result) {
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
  const std::optional<PosePrior> known = world_ ? prior(*world_, now) : std::nullopt;
  const std::optional<WorldPose> pose = worldSolver_.solve(*camera_, worldTags_, known);
  if (!pose) return;
  result.cameraFromWorld = pose->estimate.cameraFromTarget;
  result.worldRmsPx = pose->estimate.rmsPx;
  result.worldRotationSigmaRad = pose->estimate.rotationSigmaRad();
  result.worldTranslationSigmaMetres = pose->estimate.translationSigmaMetres();
  world_ = Remembered{*result.cameraFromWorld, now, pose->twinEvidence};
  for (std::size_t i = 0; i < worldTagSighting_.size(); ++i) {
    Sighting& sighting = sightings_[worldTagSighting_[i]];
    sighting.agrees = pose->agrees[i] != 0;
    if (!sighting.agrees) ++counters_.contradictingTags;
    tags_[sighting.tag].choice = pose->choice;
  }
}

void Tracker::solveTag(const Sighting& sighting, hal::TimePoint now, const TrackingResult& result) {
  TrackedTag& tag = tags_[sighting.tag];
  std::optional<Remembered>& remembered = remembered_[sighting.marker];
  double twinEvidence = kLoneEvidence;
  if (sighting.agrees) {
    twinEvidence = world_->twinEvidence;
    tag.cameraFromTag = *result.cameraFromWorld * *markers_[sighting.marker].worldFromTag;
  } else {
    const std::optional<PosePrior> known = remembered ? prior(*remembered, now) : std::nullopt;
    const std::optional<TagPose> pose = chooseTagPose(sighting.candidates, known);
    tag.cameraFromTag = pose->estimate.cameraFromTarget;
    tag.choice = pose->choice;
    twinEvidence = pose->twinEvidence;
  }
  if (tag.choice == TwinChoice::kAmbiguous) ++counters_.ambiguousTags;
  remembered = Remembered{*tag.cameraFromTag, now, twinEvidence};
}

std::optional<PosePrior> Tracker::prior(const Remembered& remembered, hal::TimePoint now) const {
  if (now - remembered.seen > options_.memory) return std::nullopt;
  return PosePrior{.cameraFromTarget = remembered.cameraFromTarget,
                   .evidence = remembered.twinEvidence};
}

}  // namespace pleinair::tracking
