#include "firmware_app/repair_station/seen_tags.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

namespace pleinair::app {
namespace {

double shortestEdgeOf(const tracking::TagCornersPx& corners) {
  double least = glm::distance(corners.back(), corners.front());
  for (std::size_t i = 0; i + 1 < corners.size(); ++i) {
    least = std::min(least, glm::distance(corners.at(i), corners.at(i + 1)));
  }
  return least;
}

double placeSigmaOf(const tracking::PoseCovariance& covariance) {
  return std::sqrt(covariance[21] + covariance[28] + covariance[35]);
}

}  // namespace

SeenTags seenTagsOf(const tracking::TrackingResult& tracking, hal::FrameSize frame,
                    hal::TimePoint captured) {
  SeenTags seen{.captured = captured};
  for (const tracking::TrackedTag& tag : tracking.tags) {
    if (tag.source == tracking::PoseSource::kSeen && seen.shownCount < SeenTags::kMaxTags) {
      seen.shown.at(seen.shownCount++) = {
          .id = tag.id, .edgeShare = shortestEdgeOf(tag.corners) / std::max(frame.height, 1)};
    }
    if (tag.cameraFromTag && seen.poseCount < SeenTags::kMaxTags) {
      seen.posedIds.at(seen.poseCount) = tag.id;
      seen.poses.at(seen.poseCount++) = {
          .source = tag.source, .rmsPx = {}, .sigmaMetres = placeSigmaOf(tag.covariance)};
    }
  }
  if (tracking.cameraFromWorld) {
    seen.world = {.source = tracking.worldSource,
                  .rmsPx = tracking.worldRmsPx,
                  .sigmaMetres = tracking.worldTranslationSigmaMetres};
  }
  return seen;
}

MachinePlace machinePlaceOf(const scene::SceneModel& machine) {
  return {.isKnown = true, .tagId = machine.tagId, .attachFromModel = machine.attachFromModel};
}

std::optional<glm::dmat4> cameraFromMachine(const MachinePlace& place,
                                            const tracking::TrackingResult& tracking) {
  if (!place.isKnown) return std::nullopt;
  if (!place.tagId) {
    if (!tracking.cameraFromWorld || tracking.worldSource != tracking::PoseSource::kSeen) {
      return std::nullopt;
    }
    return *tracking.cameraFromWorld * place.attachFromModel;
  }
  for (const tracking::TrackedTag& tag : tracking.tags) {
    const bool isIt = tag.id == *place.tagId && tag.source == tracking::PoseSource::kSeen;
    if (!isIt || !tag.cameraFromTag) continue;
    return *tag.cameraFromTag * scene::kTagFromAttach * place.attachFromModel;
  }
  return std::nullopt;
}

std::optional<record::PoseQuality> poseQualityOf(const MachinePlace& place, const SeenTags& seen) {
  if (!place.isKnown) return std::nullopt;
  std::optional<SeenTags::Pose> pose;
  if (!place.tagId) {
    pose = seen.world;
  } else {
    const auto end = seen.posedIds.begin() + static_cast<std::ptrdiff_t>(seen.poseCount);
    const auto found = std::find(seen.posedIds.begin(), end, *place.tagId);
    if (found != end) {
      pose = seen.poses.at(static_cast<std::size_t>(found - seen.posedIds.begin()));
    }
  }
  if (!pose) return record::PoseQuality{.source = "none"};
  constexpr double kMillimetresPerMetre = 1000.0;
  return record::PoseQuality{
      .source = pose->source == tracking::PoseSource::kSeen ? "seen" : "carried",
      .rmsPx = pose->rmsPx,
      .sigmaMillimetres = kMillimetresPerMetre * pose->sigmaMetres};
}

}  // namespace pleinair::app
