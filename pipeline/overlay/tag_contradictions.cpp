#include "pipeline/overlay/tag_contradictions.h"

#include <algorithm>

#include <glm/geometric.hpp>

namespace pleinair::overlay {
namespace {

/// Tracking gives a tag that fits the world's pose exactly, and any other its own (TrackedTag).
bool isWorlds(const tracking::TrackedTag& tag, const glm::dmat4& cameraFromTag) {
  constexpr double kRoundingMetres = 1e-7;
  double farthest = 0.0;
  for (int column = 0; column < 4; ++column) {
    farthest =
        std::max(farthest, glm::length((*tag.cameraFromTag)[column] - cameraFromTag[column]));
  }
  return farthest <= kRoundingMetres;
}

}  // namespace

TagContradictions::TagContradictions(const scene::Scene& scene, std::size_t machine)
    : scene_(scene),
      machineTag_(scene.models.at(machine).tagId),
      isDoubtful_(scene.tags.size(), 0) {
  agree_.reserve(scene.tags.size());
  differ_.reserve(scene.tags.size());
}

bool TagContradictions::update(const tracking::TrackingResult& tracked) {
  const bool hasWorld =
      tracked.cameraFromWorld && tracked.worldSource == tracking::PoseSource::kSeen;
  if (!hasWorld) return isMachineDoubtful_;
  agree_.clear();
  differ_.clear();
  bool isByOwnTag = false;
  for (const tracking::TrackedTag& tag : tracked.tags) {
    const tracking::TagMarker* marker = scene_.findTag(tag.id);
    const bool isOfWorld = marker != nullptr && marker->worldFromTag && tag.cameraFromTag &&
                           tag.source == tracking::PoseSource::kSeen;
    if (!isOfWorld) continue;
    const bool agrees = isWorlds(tag, *tracked.cameraFromWorld * *marker->worldFromTag);
    (agrees ? agree_ : differ_).push_back(static_cast<std::size_t>(marker - scene_.tags.data()));
    isByOwnTag = isByOwnTag || (!agrees && tag.id == machineTag_);
  }
  if (agree_.empty()) return isMachineDoubtful_;
  const bool hasMajority = agree_.size() > 1;
  for (const std::size_t tag : differ_) isDoubtful_[tag] = 1;
  for (const std::size_t tag : agree_) {
    if (hasMajority) isDoubtful_[tag] = 0;
    if (!hasMajority && !differ_.empty()) isDoubtful_[tag] = 1;
  }
  // The machine's own tag places it where it does not fit, else the world does.
  isMachineDoubtful_ = isByOwnTag || std::ranges::all_of(agree_, [&](std::size_t tag) {
                         return isDoubtful_[tag] != 0;
                       });
  return isMachineDoubtful_;
}

}  // namespace pleinair::overlay
