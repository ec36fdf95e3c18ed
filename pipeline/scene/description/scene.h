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
/// the same origin and x, but y down and z into the tag. The same half turn about x converts a
/// camera as authors see it (x right, y up, z towards the viewer) to OpenCV's camera frame. It is
/// its own inverse.
inline constexpr glm::dmat4 kTagFromAttach{1.0, 0.0, 0.0,  0.0, 0.0, -1.0, 0.0, 0.0,
                                           0.0, 0.0, -1.0, 0.0, 0.0, 0.0,  0.0, 1.0};
inline constexpr glm::dmat4 kAttachFromTag = kTagFromAttach;

struct SceneModel {
  std::string name;
  ModelSource source;
  /// Shared by models of equal source; finely subdivided where the camera's lens bends lines.
  std::shared_ptr<const Model> model;
  std::optional<int> tagId;          ///< the tag it is attached to; nothing: the world
  glm::dmat4 attachFromModel{1.0};   ///< rotation, translation and uniform scale
  double unitMetres = 1.0;           ///< a part of that scale: how long the file's unit is
  glm::vec3 srgb{0.8F, 0.5F, 0.2F};  ///< sRGB-coded; multiplies the colours of its materials
  float focus = 0.0F;                ///< 1: a style keeps it sharp; 0: painted like the rest
  Playback playback;
  bool isOccluder = false;  ///< the shape of a real object: hides models behind it and is not drawn
};

/// A flat real object whose motion in the image is thereby known: a desk, a wall, a machine's face.
struct ScenePlane {
  std::string name;
  std::optional<int> tagId;         ///< the tag it is attached to; nothing: the world
  glm::dmat4 attachFromPlane{1.0};  ///< rotation and translation; the plane is z = 0
  glm::dvec2 sizeMetres{0.0};       ///< along its x and y, centred on the origin
};

/// A place that styles paint finely, and the rest broadly: a ball.
struct SceneFocus {
  std::optional<int> tagId;          ///< the tag it is attached to; nothing: the world
  glm::dvec3 attachFromCentre{0.0};  ///< metres
  double radiusMetres = 0.0;
  double falloffMetres = 0.0;  ///< beyond the radius, over which it fades out
  double strength = 1.0;       ///< in [0, 1]: how much more broadly the rest is painted
};

/// The light that shades models: a distant key light, and uniform ambient light.
struct Light {
  enum class Frame {
    kCamera,   ///< x right, y up, z towards the viewer
    kAttached  ///< the attach frame of each model: the light does not move with the camera
  };
  /// Fixed to the models by default: bands that move with the camera would flicker.
  Frame frame = Frame::kAttached;
  /// Unit vector from the scene to the key light. The default is the upper left behind a viewer.
  glm::dvec3 towardLight{-0.37139068, 0.55708601, 0.74278135};
  /// Whether the scene gives the direction; otherwise it is estimated, if the rest is.
  bool hasDirection = false;
  /// Whether colours and strengths are estimated from camera images (light_estimator.h).
  bool isEstimated = true;
  /// Set where light is not estimated: linear colours of white paper that faces the key light and
  /// gets no other light, and of paper in ambient light only. Nothing: chosen so that paper on the
  /// plane is white.
  std::optional<glm::vec3> key;
  std::optional<glm::vec3> ambient;
  /// Strength of shadows on the plane that models are attached to: the removed part of the light
  /// that they block, 0 (none) … 1.
  float shadow = 0.9F;
};

inline constexpr std::size_t kMaxPlanes = 8;
inline constexpr std::size_t kMaxFoci = 3;

/// The contents of a scene file. A value; immutable once made, so any thread may read it.
struct Scene {
  std::optional<tracking::CameraModel> camera;  ///< nothing: assumedCamera() is used
  std::string tagFamily{tracking::kDefaultTagFamily};
  /// Each id once. worldFromTag is in tracking's tag frame; kTagFromAttach converts to the
  /// author's.
  std::vector<tracking::TagMarker> tags;
  std::vector<SceneModel> models;  ///< at most kMaxObjects
  std::vector<ScenePlane> planes;  ///< at most kMaxPlanes
  std::vector<SceneFocus> foci;    ///< at most kMaxFoci
  Light light;
  std::vector<std::string> notices;  ///< one line for each thing in its files that is not shown
  /// Files that the scene was read from besides the scene file: its calibration and models.
  std::vector<std::filesystem::path> files;

  /// Returns null if no tag has that id.
  const tracking::TagMarker* findTag(int id) const;
};

/// A camera for images of `size` without a calibration: 60° horizontal field of view, square
/// pixels, no distortion. Poses computed with it look right but are no measurements.
tracking::CameraModel assumedCamera(hal::FrameSize size);

/// The camera model of an image that gpu::aspectFill() scaled to `pictureSize`.
tracking::CameraModel fittedCamera(const tracking::CameraModel& camera, hal::FrameSize pictureSize);

}  // namespace pleinair::scene
