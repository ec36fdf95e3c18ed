#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

#include "pipeline/tracking/camera/camera_model.h"
#include "pipeline/tracking/pose/pose_refinement.h"
#include "pipeline/tracking/pose/surface_corners.h"

namespace pleinair::tracking {

/// The plane of a tag in its target's frame (z = 0), and the size of the tag.
struct TagPlane {
  glm::dmat4 targetFromTag{1.0};
  double edgeMetres = 0.0;
};

/// A pose computed from features.
struct LandmarkPose {
  PoseEstimate estimate;
  std::size_t used = 0;    ///< landmarks that agree
  double usedShare = 0.0;  ///< part of the found landmarks
};

/// Features of one target (a tag, or the world) with a position in space. A feature lies on the ray
/// through its position in the key frame, initially where the ray meets the plane of the nearest
/// tag: certain on the tag's own paper, less certain with distance from it. Its depth is then
/// learnt from its motion (Kalman update of the inverse depth; Civera, Davison and Montiel, 2008).
/// Until then, errors along the image of its ray weigh as little as its depth is known.
///
/// All positions depend on the key frame's pose of the target. That pose improves with each
/// sighting, so each call takes it anew.
class Landmarks {
 public:
  /// Creates the landmarks of the tracks' new key frame, in which the target is at `keyFromTarget`.
  /// A continued track keeps its position and its learnt depth. `onTagsOnly`: none outside of the
  /// tags' paper, for a target that moves against its surroundings. `oldKeyFromTarget`: the target
  /// in the previous key frame.
  void anchor(const CameraModel& camera, std::span<const FeatureTrack> tracks,
              const glm::dmat4& keyFromTarget, const glm::dmat4& oldKeyFromTarget,
              std::span<const TagPlane> planes, bool onTagsOnly);

  /// Solves cameraFromTarget robustly from the found tracks. Returns nothing where fewer than six,
  /// or fewer than half of them, agree. `noisePx`: noise of a feature.
  std::optional<LandmarkPose> solve(const CameraModel& camera, std::span<const FeatureTrack> tracks,
                                    const glm::dmat4& start, const glm::dmat4& keyFromTarget,
                                    double noisePx);

  /// Learns depths from a frame whose pose is known; drops landmarks that often contradict it.
  void learn(const CameraModel& camera, std::span<const FeatureTrack> tracks,
             const glm::dmat4& cameraFromTarget, const glm::dmat4& keyFromTarget, double noisePx);

  void clear() { landmarks_.clear(); }
  std::size_t size() const { return landmarks_.size(); }

 private:
  struct Landmark {
    std::uint32_t id = 0;     // of its track
    glm::dvec3 ray{0.0};      // in the key camera, z = 1
    std::size_t plane = 0;    // index in planes_
    double correction = 0.0;  // inverse depth = the plane's · (1 + correction)
    double sigma = 0.0;       // standard deviation of the correction
    int contradictions = 0;
  };

  void reserve();
  std::optional<Landmark> placed(const CameraModel& camera, const FeatureTrack& track,
                                 const glm::dmat4& keyFromTarget, bool onTagsOnly) const;
  void carryOver(Landmark& landmark, const Landmark& old, double depth,
                 const glm::dmat4& keyFromTarget) const;
  std::optional<double> planeInverseDepth(const Landmark& landmark,
                                          const glm::dmat4& keyFromTarget) const;
  /// Position in the key camera; nothing where the plane is not in front of it.
  std::optional<glm::dvec3> place(const Landmark& landmark, const glm::dmat4& keyFromTarget) const;
  void collect(const CameraModel& camera, std::span<const FeatureTrack> tracks,
               const glm::dmat4& cameraFromTarget, const glm::dmat4& keyFromTarget, double noisePx);
  std::size_t keepAgreeing(const CameraModel& camera, const glm::dmat4& cameraFromTarget,
                           double noisePx);

  std::vector<Landmark> landmarks_;  // by rising id
  std::vector<Landmark> next_;
  std::vector<TagPlane> planes_;
  std::vector<std::optional<glm::dvec3>> places_;  // per landmark, in the target's frame
  std::vector<Correspondence> points_;
  std::vector<double> errors_;
};

}  // namespace pleinair::tracking
