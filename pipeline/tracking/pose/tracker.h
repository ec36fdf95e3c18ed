#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <glm/mat4x4.hpp>

#include "hal/clock.h"
#include "hal/image.h"
#include "pipeline/tracking/camera/camera_model.h"
#include "pipeline/tracking/image/luma.h"
#include "pipeline/tracking/pose/pose_ambiguity.h"
#include "pipeline/tracking/pose/surface_corners.h"
#include "pipeline/tracking/pose/tag.h"
#include "pipeline/tracking/pose/tag_detector.h"
#include "pipeline/tracking/pose/tag_pose.h"
#include "pipeline/tracking/pose/target_pose.h"
#include "pipeline/tracking/pose/world_pose.h"

namespace pleinair::tracking {

/// What was not used, by reason: of a frame, or sums over a Tracker's life.
struct TrackingCounters {
  DetectionCounters detection;
  std::uint32_t unknownTags = 0;     ///< ids that are not in the scene
  std::uint32_t mirroredTags = 0;    ///< tags of the scene that only the mirrored picture shows
  std::uint32_t smallTags = 0;       ///< too few pixels for a pose
  std::uint32_t degenerateTags = 0;  ///< corners that allow no pose
  std::uint32_t ambiguousTags =
      0;  ///< nothing told the pose from its alternative: used all the same
  std::uint32_t contradictingTags = 0;  ///< not where the other tags put them: used by themselves
};

/// What was counted after `before`.
TrackingCounters countedSince(const TrackingCounters& before, const TrackingCounters& now);

/// A reason for not using a tag, in a word, and how often it applied.
struct Rejection {
  std::string_view reason;
  std::uint32_t count = 0;
};
std::array<Rejection, 8> rejections(const TrackingCounters& counters);

struct TrackedTag {
  int id = 0;
  /// px of the frame, pixel centres at +0.5, tagCorners()' order; where a carried tag would be.
  TagCornersPx corners{};
  /// Where the tag's size and the camera are known. That of the world where the tag agrees with it.
  std::optional<glm::dmat4> cameraFromTag;
  PoseCovariance covariance{};  ///< of cameraFromTag
  AmbiguityResolution choice =
      AmbiguityResolution::kOnly;  ///< how the pose's alternative was rejected
  PoseSource source = PoseSource::kSeen;
};

struct TrackingResult {
  /// By rising id, each id once; the Tracker's, valid until its next track(). Carried ones too.
  std::span<const TrackedTag> tags;
  std::optional<glm::dmat4> cameraFromWorld;
  PoseCovariance worldCovariance{};
  PoseSource worldSource = PoseSource::kSeen;
  double worldRmsPx = 0.0;             ///< reprojection error of the tags that agree, last seen
  double worldRotationSigmaRad = 0.0;  ///< predicted, over all axes
  double worldTranslationSigmaMetres = 0.0;
  TrackingCounters counted;  ///< in this frame
};

struct TrackerOptions {
  TagDetectorOptions detector;
  TargetPoseOptions poses;
  /// The whole picture is searched for tags at least so often; between, only where known ones must
  /// be. Zero: always.
  hal::Duration searchPeriod = std::chrono::milliseconds(150);
  /// The least edge of a tag in the picture whose pose is used: of smaller ones, every eighth pose
  /// is its alternative (docs/measured.md).
  double leastEdgePx = 15.0;
};

/// Finds tags and poses, frame by frame, in buffers that it keeps. One thread at a time.
class Tracker {
 public:
  /// Without a camera it finds tags and no poses. Throws Failure for an unknown family.
  Tracker(std::optional<CameraModel> camera, std::vector<TagMarker> markers,
          TrackerOptions options = {});

  /// Tracks a frame. Precondition: the camera's size, if there is one.
  TrackingResult track(LumaFrame& frame, hal::TimePoint captureTime);
  /// Likewise, one of any format.
  TrackingResult track(const hal::ImageView& image, hal::TimePoint captureTime);

  /// Forgets earlier poses, as after a cut.
  void reset();
  const TrackingCounters& counters() const { return counters_; }

 private:
  /// What is known of a marker, or of the world, from frame to frame.
  struct Target {
    TargetPose pose;
    double ambiguityEvidence = kLoneEvidence;
  };
  /// A tag whose size is known, with its possible poses.
  struct Sighting {
    std::size_t marker = 0;  // in markers_
    std::size_t tag = 0;     // in tags_
    PoseCandidates candidates;
    bool agrees = false;  // with the world
  };

  void predict(LumaFrame& frame, hal::TimePoint now);
  void expectTags(hal::TimePoint now);
  void findTags(const hal::PlaneView& luma, hal::FrameSize size, hal::TimePoint now);
  bool needsSearch(hal::TimePoint now) const;
  void searchMirrored(const hal::PlaneView& luma, hal::FrameSize size, hal::TimePoint now);
  void takeTags(std::span<const TagDetection> detections);
  void findSightings();
  void solveWorld(hal::TimePoint now);
  void solveTag(const Sighting& sighting, hal::TimePoint now);
  void missTags(hal::TimePoint now);
  void keepKeyFrame(hal::TimePoint now);
  void findPlanes(std::size_t marker);
  void publishTags(hal::TimePoint now);
  void publishCarried(std::size_t marker, hal::TimePoint now);
  void publishWorld(hal::TimePoint now, TrackingResult& result) const;
  std::optional<PoseEstimate> drawnTag(std::size_t marker, hal::TimePoint now) const;
  std::optional<PoseEstimate> worldTag(std::size_t marker, hal::TimePoint now) const;
  static std::optional<PosePrior> prior(const Target& target);

  std::optional<CameraModel> camera_;
  std::vector<TagMarker> markers_;
  TrackerOptions options_;
  TagDetector detector_;
  LumaFrame own_;  // of frames that come as images
  SurfaceCorners features_;
  TrackingCounters counters_;
  WorldPoseSolver worldSolver_;
  Target world_;
  std::vector<Target> targets_;            // of each marker, where it is not with the world
  std::vector<std::uint8_t> isWithWorld_;  // of each marker: agreed when it was seen last
  std::vector<std::uint8_t> isSeen_;       // of each marker, in the last frame
  std::vector<TagPlane> worldPlanes_;
  std::vector<TagPlane> planes_;
  std::vector<glm::dvec3> worldModel_;           // points that must look right
  std::vector<std::vector<glm::dvec3>> models_;  // of each marker
  hal::TimePoint keyMade_;
  std::optional<hal::TimePoint> searched_;  // the whole picture
  bool isMissing_ = false;                  // an expected tag, in the last frame
  std::optional<hal::TimePoint> searchedMirrored_;
  std::vector<std::uint8_t> mirrored_;  // the picture
  std::vector<TrackedTag> tags_;        // of the last frame, as all below
  std::vector<ExpectedTag> expected_;
  std::vector<Sighting> sightings_;
  std::vector<WorldTag> worldTags_;            // the sightings with a place in the world
  std::vector<std::size_t> worldTagSighting_;  // of each, in sightings_
  std::vector<TagCornersPx> keyTags_;
};

/// Whether a calibration is for frames of this size, else an error (kInvalidInput) that names both:
/// scaling it in silence would be wrong for a sensor that crops.
hal::Result<void> checkSize(const CameraModel& camera, hal::FrameSize frame,
                            std::string calibration);

}  // namespace pleinair::tracking
