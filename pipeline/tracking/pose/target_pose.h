#pragma once

#include <optional>
#include <span>
#include <vector>

#include <glm/mat4x4.hpp>

#include "hal/clock.h"
#include "pipeline/tracking/camera/camera_model.h"
#include "pipeline/tracking/pose/landmarks.h"
#include "pipeline/tracking/pose/pose_filter.h"
#include "pipeline/tracking/pose/pose_refinement.h"
#include "pipeline/tracking/pose/surface_corners.h"

namespace pleinair::tracking {

/// What a pose is known from.
enum class PoseSource {
  kSeen,    ///< tags in this frame
  kCarried  ///< tags seen a little earlier, and features since
};

struct TargetPoseOptions {
  bool filters = true;  ///< else a pose is what the frame's tags say
  bool carries = true;  ///< else there is none without tags
  hal::Duration carryFor = std::chrono::milliseconds(500);
  hal::Duration blendOver = std::chrono::milliseconds(130);
};

/// A target's pose from frame to frame: filtered while its tags are seen, carried by features while
/// they are not, dropped after a while without; and what was wrong when they come back is blended
/// away, so that nothing jumps. Each frame: predict(), then see() or miss(); anchor() where the
/// frame becomes the features' key frame.
class TargetPose {
 public:
  explicit TargetPose(TargetPoseOptions options = {}) : options_(options) {}

  /// Where features put the target in this frame, before tags are looked at.
  void predict(const CameraModel& camera, std::span<const FeatureTrack> tracks, hal::TimePoint now);
  /// Nothing before the first sighting, and when it was too long ago.
  std::optional<PoseEstimate> predicted() const;

  /// Its tags were seen. `modelPoints`, in the target's frame, are what must look right: errors are
  /// judged by where they appear.
  void see(const CameraModel& camera, std::span<const FeatureTrack> tracks,
           const PoseEstimate& seen, std::span<const glm::dvec3> modelPoints, hal::TimePoint now);
  void miss(hal::TimePoint now);

  /// This frame becomes the key frame; `planes` of the target's tags.
  void anchor(const CameraModel& camera, std::span<const FeatureTrack> tracks,
              std::span<const TagPlane> planes);
  /// Whether it is known, and has not been anchored since.
  bool needsLandmarks() const { return isKnown_ && !isAnchored_; }

  /// Whether it moves against the features around it.
  bool movesAlone() const { return movesAlone_; }

  /// What is to be drawn; nothing where nothing is known.
  std::optional<PoseEstimate> drawn(hal::TimePoint now) const;
  PoseSource source() const { return source_; }

  void reset();

 private:
  void moveByFeatures(const LandmarkPose& moved);
  void moveOn(const CameraModel& camera, double seconds);
  void correct(const CameraModel& camera, const PoseEstimate& seen,
               std::span<const glm::dvec3> modelPoints, hal::TimePoint now);
  double partOfBlend(hal::TimePoint now) const;
  double noisePx(const CameraModel& camera) const;

  TargetPoseOptions options_;
  Landmarks landmarks_;
  PoseFilter filter_;
  glm::dmat4 keyFromTarget_{1.0};
  glm::dmat4 cameraFromKey_{1.0};
  bool isKnown_ = false;
  bool isAnchored_ = false;
  bool movesAlone_ = false;
  int doubts_ = 0;
  hal::TimePoint movedAlone_;
  hal::TimePoint seen_;
  hal::TimePoint last_;
  glm::dmat4 lastDrawn_{1.0};
  glm::dmat4 before_{1.0};  ///< the pose of the last frame
  Twist velocity_;          ///< a second
  Twist bias_;              ///< mean of what sightings lately differed from the predicted by
  Twist offset_;            ///< from the filtered pose to the drawn one, when blending began
  hal::TimePoint blendFrom_;
  PoseSource source_ = PoseSource::kSeen;
  PoseCovariance shared_{};  ///< of what all sightings from here are wrong by alike
  double rmsPx_ = 0.0;
};

}  // namespace pleinair::tracking
