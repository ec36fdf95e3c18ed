#include "pipeline/scene/scene_bodies.h"

#include <optional>

namespace pleinair::scene {
namespace {

void advanceTo(Body& body, const std::optional<Attachment>& attachment,
               const glm::dmat4& attachFromBody) {
  body.then = body.now;
  body.now.reset();
  if (!attachment) return;
  body.now = Body::Moment{.cameraFromBody = attachment->cameraFromAttach * attachFromBody,
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
