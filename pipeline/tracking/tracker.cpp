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
      detector_(options_.detector) {}

void Tracker::reset() {
  world_.reset();
  tags_.clear();
}

TrackingResult Tracker::track(const hal::ImageView& image, hal::TimePoint captureTime) {
  assert(!camera_ || camera_->imageSize() == image.format.size);
  TrackingResult result;
  for (const TagDetection& detection :
       detector_.detect(luma_.convert(image), image.format.size, counters_.detection)) {
    result.tags.push_back({.id = detection.id, .corners = detection.corners});
  }
  if (!camera_) return result;
  const std::vector<Sighting> seen = sightings(result);
  const std::vector<bool> agrees = solveWorld(seen, captureTime, result);
  solveTags(seen, agrees, captureTime, result);
  return result;
}

/// The tags whose size is known, with their possible poses.
std::vector<Tracker::Sighting> Tracker::sightings(const TrackingResult& result) {
  std::vector<Sighting> seen;
  for (std::size_t i = 0; i < result.tags.size(); ++i) {
    const auto marker = std::ranges::find(markers_, result.tags[i].id, &TagMarker::id);
    if (marker == markers_.end()) continue;
    auto candidates = tagPoseCandidates(*camera_, result.tags[i].corners, marker->edgeMetres);
    if (candidates.empty()) {
      ++counters_.degenerateTags;
      continue;
    }
    seen.push_back({&*marker, i, std::move(candidates)});
  }
  return seen;
}

/// Which of the sightings agree with the world; all false without one.
std::vector<bool> Tracker::solveWorld(const std::vector<Sighting>& sightings, hal::TimePoint now,
                                      TrackingResult& result) {
  std::vector<bool> agrees(sightings.size(), false);
  std::vector<WorldTag> tags;
  std::vector<std::size_t> origins;
  for (std::size_t i = 0; i < sightings.size(); ++i) {
    const TagMarker& marker = *sightings[i].marker;
    if (!marker.worldFromTag) continue;
    tags.push_back({.worldFromTag = *marker.worldFromTag,
                    .edgeMetres = marker.edgeMetres,
                    .corners = result.tags[sightings[i].index].corners,
                    .candidates = sightings[i].candidates});
    origins.push_back(i);
  }
  const std::optional<PosePrior> known = world_ ? prior(*world_, now) : std::nullopt;
  const std::optional<WorldPose> pose = solveWorldPose(*camera_, tags, known);
  if (!pose) return agrees;
  result.cameraFromWorld = pose->estimate.cameraFromTarget;
  result.worldRmsPx = pose->estimate.rmsPx;
  result.worldRotationSigmaRad = pose->estimate.rotationSigmaRad();
  result.worldTranslationSigmaMetres = pose->estimate.translationSigmaMetres();
  world_ = Remembered{*result.cameraFromWorld, now, pose->twinEvidence};
  for (std::size_t i = 0; i < origins.size(); ++i) {
    agrees[origins[i]] = pose->agrees[i];
    if (!pose->agrees[i]) ++counters_.contradictingTags;
    result.tags[sightings[origins[i]].index].choice = pose->choice;
  }
  return agrees;
}

void Tracker::solveTags(const std::vector<Sighting>& sightings, const std::vector<bool>& agrees,
                        hal::TimePoint now, TrackingResult& result) {
  for (std::size_t i = 0; i < sightings.size(); ++i) {
    TrackedTag& tag = result.tags[sightings[i].index];
    double twinEvidence = kLoneEvidence;
    if (agrees[i]) {
      twinEvidence = world_->twinEvidence;
      tag.cameraFromTag = *result.cameraFromWorld * *sightings[i].marker->worldFromTag;
    } else {
      const auto remembered = tags_.find(tag.id);
      const std::optional<PosePrior> known =
          remembered == tags_.end() ? std::nullopt : prior(remembered->second, now);
      const std::optional<TagPose> pose = chooseTagPose(sightings[i].candidates, known);
      tag.cameraFromTag = pose->estimate.cameraFromTarget;
      tag.choice = pose->choice;
      twinEvidence = pose->twinEvidence;
    }
    if (tag.choice == TwinChoice::kAmbiguous) ++counters_.ambiguousTags;
    tags_[tag.id] = Remembered{*tag.cameraFromTag, now, twinEvidence};
  }
}

std::optional<PosePrior> Tracker::prior(const Remembered& remembered, hal::TimePoint now) const {
  if (now - remembered.seen > options_.memory) return std::nullopt;
  return PosePrior{.cameraFromTarget = remembered.cameraFromTarget,
                   .evidence = remembered.twinEvidence};
}

}  // namespace pleinair::tracking
