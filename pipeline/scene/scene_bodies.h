#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include <glm/mat4x4.hpp>

#include "pipeline/scene/attachment.h"
#include "pipeline/scene/pose_set.h"
#include "pipeline/scene/scene.h"

namespace pleinair::scene {

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
