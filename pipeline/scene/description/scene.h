#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

#include "pipeline/scene/description/model_source.h"
#include "pipeline/scene/models/model.h"
#include "pipeline/scene/models/rig.h"
#include "pipeline/tracking/camera/camera_model.h"
#include "pipeline/tracking/pose/tracker.h"

namespace pleinair::scene {

/// Authors of scenes see a tag as it lies on a desk or hangs on a wall: x to its right, y to its
/// top, z out of it towards the viewer (the attach frame). Tracking's tag frame (tagCorners()) has
/// the same origin and x, but y down and z into the tag. The same half turn about x goes from a
/// camera as authors see it (x right, y up, z towards the viewer) to OpenCV's camera frame. It is
/// its own inverse.
inline constexpr glm::dmat4 kTagFromAttach{1.0, 0.0, 0.0,  0.0, 0.0, -1.0, 0.0, 0.0,
                                           0.0, 0.0, -1.0, 0.0, 0.0, 0.0,  0.0, 1.0};
inline constexpr glm::dmat4 kAttachFromTag = kTagFromAttach;

struct SceneModel {
  std::string name;
  ModelSource source;
  /// Shared by models of equal source; cut up finely where the camera's lens bends lines.
  std::shared_ptr<const Model> model;
  std::optional<int> tagId;          ///< what it is attached to; nothing: the world
  glm::dmat4 attachFromModel{1.0};   ///< rotation, translation and uniform scale
  glm::vec3 srgb{0.8F, 0.5F, 0.2F};  ///< sRGB-coded; its materials' colours are multiplied by it
  float focus = 0.0F;                ///< 1: a style keeps it crisp; 0: painted like the rest
  Playback playback;
  bool isOccluder = false;  ///< a real thing's shape: hides what is behind it and is not drawn
};

/// A flat real thing, so that its motion in the picture is known: a desk, a wall, a machine's face.
struct ScenePlane {
  std::string name;
  std::optional<int> tagId;         ///< what it is attached to; nothing: the world
  glm::dmat4 attachFromPlane{1.0};  ///< rotation and translation; it lies on its z = 0
  glm::dvec2 sizeMetres{0.0};       ///< along its x and y, its middle in the origin
};

/// The light that models are shaded by: a key light, which is far away, and an even one around it.
struct Light {
  enum class Frame {
    kCamera,   ///< x right, y up, z towards the viewer
    kAttached  ///< the attach frame of each model: the light stays put when the camera moves
  };
  /// By default fixed to what is lit: bands that wander as the camera moves would flicker.
  Frame frame = Frame::kAttached;
  /// Unit vector from the scene to the key light. The default is the upper left behind a viewer.
  glm::dvec3 towardLight{-0.37139068, 0.55708601, 0.74278135};
  /// Whether the scene says so: else it is estimated where the rest is.
  bool hasDirection = false;
  /// Whether colours and strengths come from the camera's pictures (light_estimator.h).
  bool isEstimated = true;
  /// Where they do not: linear, of what white paper shows, which faces the key light and sees no
  /// other, or sees the even light alone. Nothing: so that paper on the plane is white.
  std::optional<glm::vec3> key;
  std::optional<glm::vec3> ambient;
  /// Of models on the plane of what they are attached to: how much of the light it takes that it
  /// could, 0 (none) … 1.
  float shadow = 0.9F;
};

inline constexpr std::size_t kMaxPlanes = 8;

/// What a scene file says. A value; immutable once made, so any thread may read it.
struct Scene {
  std::optional<tracking::CameraModel> camera;  ///< nothing: assumedCamera() has to do
  std::string tagFamily{tracking::kDefaultTagFamily};
  /// Each id once. Their worldFromTag is of tracking's tag frame; attach_frame.h has the author's.
  std::vector<tracking::TagMarker> tags;
  std::vector<SceneModel> models;  ///< at most kMaxObjects
  std::vector<ScenePlane> planes;  ///< at most kMaxPlanes
  Light light;
  std::vector<std::string> notices;  ///< what of its files is not shown, a line each
  /// What it was read from beside the scene file: its calibration and models.
  std::vector<std::filesystem::path> files;

  /// Null where no tag has that id.
  const tracking::TagMarker* findTag(int id) const;
};

/// A camera for pictures of `size` whose lens nobody has measured: 60° from left to right, square
/// pixels, no distortion. Poses it gives look right but are no measurements.
tracking::CameraModel assumedCamera(hal::FrameSize size);

/// The model for a camera's picture as gpu::coverFit() lays it onto `pictureSize`.
tracking::CameraModel fittedCamera(const tracking::CameraModel& camera, hal::FrameSize pictureSize);

}  // namespace pleinair::scene
