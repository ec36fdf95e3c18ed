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

/// A tag's plane in a target: its z = 0, and how large the tag on it is.
struct TagPlane {
  glm::dmat4 targetFromTag{1.0};
  double edgeMetres = 0.0;
};

/// A pose that features tell.
struct LandmarkPose {
  PoseEstimate estimate;
  std::size_t used = 0;    ///< landmarks that agree
  double usedShare = 0.0;  ///< of the found ones
};

/// Features with a place in space, of one target (a tag, or the world). A feature lies on the ray
/// through its place in the key frame, first where the nearest tag's plane cuts it: surely on the
/// tag's own paper, less so with the distance from it. Its depth is then learnt from how it moves
/// (Kalman's update of the inverse depth; Civera, Davison and Montiel, 2008). Until that, how it
/// moves along its ray's picture counts as little as its depth is known.
///
/// Since all hang on the key frame's pose of the target, which is known better with each sighting,
/// that pose is given at each call.
class Landmarks {
 public:
  /// What the tracks' key frame, where the target was at `keyFromTarget`, shows of them; landmarks
  /// of tracks that go on keep their place and what was learnt. `onTagsOnly`: none beside the tags'
  /// paper, for a target that moves against what is around it.
  /// `oldKeyFromTarget`: of the key frame before.
  void anchor(const CameraModel& camera, std::span<const FeatureTrack> tracks,
              const glm::dmat4& keyFromTarget, const glm::dmat4& oldKeyFromTarget,
              std::span<const TagPlane> planes, bool onTagsOnly);

  /// cameraFromTarget by the found tracks, robustly: nothing where fewer than six agree, or fewer
  /// than half. `noisePx`: of a feature.
  std::optional<LandmarkPose> solve(const CameraModel& camera, std::span<const FeatureTrack> tracks,
                                    const glm::dmat4& start, const glm::dmat4& keyFromTarget,
                                    double noisePx);

  /// Learns depths from a frame with a known pose, and forgets landmarks that contradict it often.
  void learn(const CameraModel& camera, std::span<const FeatureTrack> tracks,
             const glm::dmat4& cameraFromTarget, const glm::dmat4& keyFromTarget, double noisePx);

  void clear() { landmarks_.clear(); }
  std::size_t size() const { return landmarks_.size(); }

 private:
  struct Landmark {
    std::uint32_t id = 0;     // of its track
    glm::dvec3 ray{0.0};      // of the key camera, z = 1
    std::size_t plane = 0;    // in planes_
    double correction = 0.0;  // inverse depth = the plane's · (1 + correction)
    double sigma = 0.0;       // of the correction
    int contradictions = 0;
  };

  void reserve();
  std::optional<Landmark> placed(const CameraModel& camera, const FeatureTrack& track,
                                 const glm::dmat4& keyFromTarget, bool onTagsOnly) const;
  void goOn(Landmark& landmark, const Landmark& old, double depth,
            const glm::dmat4& keyFromTarget) const;
  std::optional<double> planeInverseDepth(const Landmark& landmark,
                                          const glm::dmat4& keyFromTarget) const;
  /// In the key camera; nothing where the plane is not before it.
  std::optional<glm::dvec3> place(const Landmark& landmark, const glm::dmat4& keyFromTarget) const;
  void collect(const CameraModel& camera, std::span<const FeatureTrack> tracks,
               const glm::dmat4& cameraFromTarget, const glm::dmat4& keyFromTarget, double noisePx);
  std::size_t keepAgreeing(const CameraModel& camera, const glm::dmat4& cameraFromTarget,
                           double noisePx);

  std::vector<Landmark> landmarks_;  // by rising id
  std::vector<Landmark> next_;
  std::vector<TagPlane> planes_;
  std::vector<std::optional<glm::dvec3>> places_;  // of each landmark, in the target
  std::vector<Correspondence> points_;
  std::vector<double> errors_;
};

}  // namespace pleinair::tracking
