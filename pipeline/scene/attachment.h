#pragma once

#include <optional>

#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

#include "pipeline/scene/pose_set.h"
#include "pipeline/scene/scene.h"

namespace pleinair::scene {

/// Where an attach frame (attach_frame.h) is, and how sure that is.
struct Attachment {
  glm::dmat4 cameraFromAttach{1.0};
  tracking::PoseCovariance covariance{};
  glm::dvec3 turnsAbout{0.0};  ///< the covariance's origin, camera frame, metres
};

/// That of a tag, or of the world (nothing); nothing where no pose tells it. A tag that is hidden
/// is where the world has it. Precondition: the scene has the tag.
std::optional<Attachment> attachmentOf(const Scene& scene, std::optional<int> tagId,
                                       const PoseSet& poses);

}  // namespace pleinair::scene
