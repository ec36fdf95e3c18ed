#include "pipeline/overlay/tag_contradictions.h"

#include <algorithm>
#include <utility>

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

TagContradictions::TagContradictions(const scene::Scene& scene, std::size_t machine,
                                     std::shared_ptr<DoubtfulTags> kept)
    : scene_(scene),
      machineTag_(scene.models.at(machine).tagId),
      isPlacedByWorld_(isInWorld(scene, machineTag_)),
      known_(kept ? std::move(kept) : std::make_shared<DoubtfulTags>()) {
  if (known_->isDoubtful.size() != scene.tags.size()) {
    *known_ = {.isDoubtful = std::vector<std::uint8_t>(scene.tags.size())};
  }
  agree_.reserve(scene.tags.size());
  differ_.reserve(scene.tags.size());
}

bool TagContradictions::update(const tracking::TrackingResult& tracked) {
  std::vector<std::uint8_t>& isDoubtful = known_->isDoubtful;
  const bool hasWorld =
      tracked.cameraFromWorld && tracked.worldSource == tracking::PoseSource::kSeen;
  if (!hasWorld) return known_->isMachineDoubtful;
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
  if (agree_.empty()) return known_->isMachineDoubtful;
  const bool hasMajority = agree_.size() > 1;
  for (const std::size_t tag : differ_) isDoubtful[tag] = 1;
  for (const std::size_t tag : agree_) {
    if (hasMajority) isDoubtful[tag] = 0;
    if (!hasMajority && !differ_.empty()) isDoubtful[tag] = 1;
  }
  // The machine's own tag places it where it does not fit, else the world does.
  const bool isWorldDoubtful =
      std::ranges::all_of(agree_, [&](std::size_t tag) { return isDoubtful[tag] != 0; });
  known_->isMachineDoubtful = isByOwnTag || (isPlacedByWorld_ && isWorldDoubtful);
  return known_->isMachineDoubtful;
}

}  // namespace pleinair::overlay
