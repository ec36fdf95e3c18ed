#include "pipeline/scene/render/scene_bodies.h"

#include <algorithm>
#include <cassert>
#include <optional>

#include "pipeline/scene/description/scene.h"

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

namespace {

void advanceTo(Body& body, const std::optional<Attachment>& attachment,
               const glm::dmat4& attachFromBody) {
  body.previous = body.current;
  body.current.reset();
  if (!attachment) return;
  body.current = Body::Moment{.cameraFromBody = attachment->cameraFromAttach * attachFromBody,
                              .attachment = *attachment};
}

}  // namespace

SceneBodies::SceneBodies(const Scene& scene)
    : scene_(scene), models_(scene.models.size()), planes_(scene.planes.size()) {}

void SceneBodies::advance(const PoseSet& poses) {
  for (std::size_t i = 0; i < models_.size(); ++i) {
    const SceneModel& model = scene_.models[i];
    advanceTo(models_[i], attachmentOf(scene_, model.tagId, poses), model.attachFromModel);
  }
  for (std::size_t i = 0; i < planes_.size(); ++i) {
    const ScenePlane& plane = scene_.planes[i];
    advanceTo(planes_[i], attachmentOf(scene_, plane.tagId, poses), plane.attachFromPlane);
  }
}

void SceneBodies::reset() {
  for (Body& body : models_) body = {};
  for (Body& body : planes_) body = {};
}

}  // namespace pleinair::scene
