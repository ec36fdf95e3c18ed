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

/// Whether the world's pose gives that of what is attached to the tag, or to no tag.
bool isInWorld(const scene::Scene& scene, std::optional<int> tagId) {
  if (!tagId) return true;
  const tracking::TagMarker* marker = scene.findTag(*tagId);
  return marker != nullptr && marker->worldFromTag;
}

}  // namespace

TagContradictions::TagContradictions(const scene::Scene& scene, std::size_t machine)
    : scene_(scene),
      machineTag_(scene.models.at(machine).tagId),
      isPlacedByWorld_(isInWorld(scene, machineTag_)),
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
    if (marker == nullptr || !marker->worldFromTag || !tag.cameraFromTag) continue;
    const bool agrees = isWorlds(tag, *tracked.cameraFromWorld * *marker->worldFromTag);
    isByOwnTag = isByOwnTag || (!agrees && tag.id == machineTag_);  // also while it is carried
    if (tag.source != tracking::PoseSource::kSeen) continue;
    (agrees ? agree_ : differ_).push_back(static_cast<std::size_t>(marker - scene_.tags.data()));
  }
  if (agree_.empty()) return isMachineDoubtful_;
  const bool hasMajority = agree_.size() > 1;
  for (const std::size_t tag : differ_) isDoubtful_[tag] = 1;
  for (const std::size_t tag : agree_) {
    if (hasMajority) isDoubtful_[tag] = 0;
    if (!hasMajority && !differ_.empty()) isDoubtful_[tag] = 1;
  }
  // The machine's own tag places it where it does not fit, else the world does.
  const bool isWorldDoubtful =
      std::ranges::all_of(agree_, [&](std::size_t tag) { return isDoubtful_[tag] != 0; });
  isMachineDoubtful_ = isByOwnTag || (isPlacedByWorld_ && isWorldDoubtful);
  return isMachineDoubtful_;
}

}  // namespace pleinair::overlay
