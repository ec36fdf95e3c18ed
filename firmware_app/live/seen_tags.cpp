#include "firmware_app/live/seen_tags.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <system_error>
#include <variant>
#include <vector>

#include <glm/geometric.hpp>

namespace pleinair::app {
namespace {

namespace fs = std::filesystem;

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

/// Equal files under different paths are the same machine.
bool isSameSource(const scene::ModelSource& a, const scene::ModelSource& b) {
  const auto* fileA = std::get_if<scene::FileSource>(&a);
  const auto* fileB = std::get_if<scene::FileSource>(&b);
  if (fileA == nullptr || fileB == nullptr) return a == b;
  std::error_code failure;
  return fileA->path == fileB->path || fs::equivalent(fileA->path, fileB->path, failure);
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

MachinePlace machinePlaceOf(const scene::Scene& scene, const procedure::Procedure& procedure) {
  std::vector<const scene::SceneModel*> drawn;
  for (const scene::SceneModel& model : scene.models) {
    if (!model.isOccluder) drawn.push_back(&model);
  }
  const auto same = std::ranges::find_if(drawn, [&](const scene::SceneModel* model) {
    return isSameSource(model->source, procedure.source);
  });
  const scene::SceneModel* machine = same != drawn.end() ? *same : nullptr;
  if (machine == nullptr && drawn.size() == 1) machine = drawn.front();
  if (machine == nullptr) return {};
  return {.isKnown = true, .tagId = machine->tagId, .attachFromModel = machine->attachFromModel};
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
