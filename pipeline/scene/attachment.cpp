#include "pipeline/scene/attachment.h"

#include <algorithm>
#include <cassert>

#include "pipeline/scene/attach_frame.h"

namespace pleinair::scene {

std::optional<Attachment> attachmentOf(const Scene& scene, std::optional<int> tagId,
                                       const PoseSet& poses) {
  if (tagId) {
    const auto seen = std::ranges::find(poses.tags, *tagId, &TagSighting::id);
    if (seen != poses.tags.end()) {
      return Attachment{.cameraFromAttach = seen->cameraFromTag * kTagFromAttach,
                        .covariance = seen->covariance,
                        .turnsAbout = glm::dvec3(seen->cameraFromTag[3])};
    }
  }
  if (!poses.cameraFromWorld) return std::nullopt;
  Attachment attachment{.cameraFromAttach = *poses.cameraFromWorld,
                        .covariance = poses.worldCovariance,
                        .turnsAbout = glm::dvec3((*poses.cameraFromWorld)[3])};
  if (!tagId) return attachment;
  const tracking::TagMarker* tag = scene.findTag(*tagId);
  assert(tag != nullptr);
  if (!tag->worldFromTag) return std::nullopt;
  attachment.cameraFromAttach = *poses.cameraFromWorld * *tag->worldFromTag * kTagFromAttach;
  return attachment;
}

}  // namespace pleinair::scene
