#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

#include "pipeline/scene/description/scene.h"
#include "pipeline/scene/render/ar_frame.h"
#include "pipeline/tracking/pose/pose_refinement.h"

namespace pleinair::scene {

/// A visible tag and its pose: from tracking's tag frame to OpenCV's camera frame
/// (tracking::TrackedTag::cameraFromTag, which agrees with the world's pose where the tag does).
struct TagSighting {
  int id = 0;
  glm::dmat4 cameraFromTag{1.0};
  tracking::PoseCovariance covariance{};
};

/// All poses known in one frame. Refers to the sightings' memory.
struct PoseSet {
  std::optional<glm::dmat4> cameraFromWorld;
  tracking::PoseCovariance worldCovariance{};
  std::span<const TagSighting> tags;
};

/// Pose of an attach frame (kTagFromAttach) and its covariance.
struct Attachment {
  glm::dmat4 cameraFromAttach{1.0};
  tracking::PoseCovariance covariance{};
  glm::dvec3 turnsAbout{0.0};  ///< origin of the covariance, camera frame, metres
};

/// The attachment of a tag, or of the world (no id); nothing if no pose gives it. The pose of a
/// hidden tag is computed from the world's. Precondition: the scene has the tag.
std::optional<Attachment> attachmentOf(const Scene& scene, std::optional<int> tagId,
                                       const PoseSet& poses);

/// The id in ArFrame::ids of a model of the scene, counted from 0.
inline std::uint32_t objectId(const Scene& scene, std::size_t model) {
  const auto number = static_cast<std::uint32_t>(model) + 1U;
  return scene.models[model].isOccluder ? number | kRealObject : number;
}

/// A body that moves as one in front of the camera: a whole model, or a plane.
struct Body {
  struct Moment {
    glm::dmat4 cameraFromBody{1.0};
    Attachment attachment;
  };
  std::optional<Moment> current;   ///< nothing if the pose is unknown
  std::optional<Moment> previous;  ///< in the previous frame
};

/// Poses of a scene's models and planes in this frame and the previous one.
class SceneBodies {
 public:
  explicit SceneBodies(const Scene& scene);

  /// Takes the next frame's poses.
  void advance(const PoseSet& poses);
  /// Forgets the previous frame.
  void reset();

  const Body& model(std::size_t index) const { return models_[index]; }
  const Body& plane(std::size_t index) const { return planes_[index]; }

 private:
  const Scene& scene_;
  std::vector<Body> models_;
  std::vector<Body> planes_;
};

}  // namespace pleinair::scene
