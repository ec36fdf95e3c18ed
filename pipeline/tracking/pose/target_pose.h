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

/// Source of a pose.
enum class PoseSource {
  kSeen,    ///< tags in this frame
  kCarried  ///< tags seen a little earlier, and features since
};

struct TargetPoseOptions {
  bool filters = true;  ///< false: a pose is that of the frame's tags
  bool carries = true;  ///< false: there is no pose without tags
  hal::Duration carryFor = std::chrono::milliseconds(500);
  hal::Duration blendOver = std::chrono::milliseconds(130);
};

/// A target's pose from frame to frame: filtered while its tags are seen, carried by features while
/// they are not, and dropped after a while without. When the tags reappear, the error is blended
/// away, so that nothing jumps. Per frame: predict(), then see() or miss(); anchor() where the
/// frame becomes the features' key frame.
class TargetPose {
 public:
  explicit TargetPose(TargetPoseOptions options = {}) : options_(options) {}

  /// Predicts the target's pose in this frame from features, before tags are searched.
  void predict(const CameraModel& camera, std::span<const FeatureTrack> tracks, hal::TimePoint now);
  /// Nothing before the first sighting, and when it was too long ago.
  std::optional<PoseEstimate> predicted() const;

  /// Takes the pose from the tags seen. `modelPoints`, in the target's frame, are where accuracy
  /// matters: errors are judged by their projections.
  void see(const CameraModel& camera, std::span<const FeatureTrack> tracks,
           const PoseEstimate& seen, std::span<const glm::dvec3> modelPoints, hal::TimePoint now);
  void miss(hal::TimePoint now);

  /// Makes this frame the key frame; `planes` are those of the target's tags.
  void anchor(const CameraModel& camera, std::span<const FeatureTrack> tracks,
              std::span<const TagPlane> planes);
  /// Whether the pose is known and has not been anchored since.
  bool needsLandmarks() const { return isKnown_ && !isAnchored_; }

  /// Whether the target moves against the features around it.
  bool movesAlone() const { return movesAlone_; }

  /// The pose to draw with; nothing where it is unknown.
  std::optional<PoseEstimate> drawn(hal::TimePoint now) const;
  PoseSource source() const { return source_; }

  void reset();

 private:
  void moveByFeatures(const LandmarkPose& moved);
  void extrapolate(const CameraModel& camera, double seconds);
  void correct(const CameraModel& camera, const PoseEstimate& seen,
               std::span<const glm::dvec3> modelPoints, hal::TimePoint now);
  double blendWeight(hal::TimePoint now) const;
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
  glm::dmat4 before_{1.0};  ///< pose in the previous frame
  Twist velocity_;          ///< per second
  Twist bias_;              ///< mean of the recent sightings' differences from their predictions
  Twist offset_;            ///< from the filtered pose to the drawn one, when blending began
  hal::TimePoint blendFrom_;
  PoseSource source_ = PoseSource::kSeen;
  PoseCovariance shared_{};  ///< error that all sightings from this position share
  double rmsPx_ = 0.0;
};

}  // namespace pleinair::tracking
