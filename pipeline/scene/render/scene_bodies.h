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

/// A tag that is seen, and where: OpenCV's camera frame from tracking's tag frame
/// (tracking::TrackedTag::cameraFromTag, which agrees with the world's pose where the tag does).
struct TagSighting {
  int id = 0;
  glm::dmat4 cameraFromTag{1.0};
  tracking::PoseCovariance covariance{};
};

/// What one frame knows of poses. Refers to the sightings' memory.
struct PoseSet {
  std::optional<glm::dmat4> cameraFromWorld;
  tracking::PoseCovariance worldCovariance{};
  std::span<const TagSighting> tags;
};

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

/// What ArFrame::ids say of a model of the scene, counted from 0.
inline std::uint32_t objectId(const Scene& scene, std::size_t model) {
  const auto number = static_cast<std::uint32_t>(model) + 1U;
  return scene.models[model].isOccluder ? number | kRealObject : number;
}

/// What moves as one in front of the camera: a model as a whole, or a plane.
struct Body {
  struct Moment {
    glm::dmat4 cameraFromBody{1.0};
    Attachment attachment;
  };
  std::optional<Moment> now;   ///< nothing where its pose is not known
  std::optional<Moment> then;  ///< in the frame before
};

/// Where a scene's models and planes are, in this frame and the one before.
class SceneBodies {
 public:
  explicit SceneBodies(const Scene& scene);

  /// The next frame's poses.
  void advance(const PoseSet& poses);
  /// Forgets the frame before.
  void reset();

  const Body& model(std::size_t index) const { return models_[index]; }
  const Body& plane(std::size_t index) const { return planes_[index]; }

 private:
  const Scene& scene_;
  std::vector<Body> models_;
  std::vector<Body> planes_;
};

}  // namespace pleinair::scene
