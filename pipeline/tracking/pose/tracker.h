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

/// Tags that were not used, by reason: for one frame, or summed over a Tracker's life.
struct TrackingCounters {
  DetectionCounters detection;
  std::uint32_t unknownTags = 0;        ///< ids that are not in the scene
  std::uint32_t mirroredTags = 0;       ///< tags of the scene, seen only in the mirrored image
  std::uint32_t smallTags = 0;          ///< too few pixels for a pose
  std::uint32_t degenerateTags = 0;     ///< corners that allow no pose
  std::uint32_t ambiguousTags = 0;      ///< pose ambiguity left open; the tag was used
  std::uint32_t contradictingTags = 0;  ///< at odds with the other tags; used on their own
};

/// The counts since `before`.
TrackingCounters countedSince(const TrackingCounters& before, const TrackingCounters& now);

/// A reason for not using a tag, in one word, and its count.
struct Rejection {
  std::string_view reason;
  std::uint32_t count = 0;
};
std::array<Rejection, 8> rejections(const TrackingCounters& counters);

struct TrackedTag {
  int id = 0;
  /// px of the frame, pixel centres at +0.5, in tagCorners()' order; projected for a carried tag.
  TagCornersPx corners{};
  /// Set where the tag's size and the camera are known. From the world's pose where the tag agrees
  /// with it.
  std::optional<glm::dmat4> cameraFromTag;
  PoseCovariance covariance{};                              ///< of cameraFromTag
  AmbiguityResolution choice = AmbiguityResolution::kOnly;  ///< how the pose ambiguity was resolved
  PoseSource source = PoseSource::kSeen;
};

struct TrackingResult {
  /// By rising id, each id once, carried tags included. Owned by the Tracker; valid until its next
  /// track().
  std::span<const TrackedTag> tags;
  std::optional<glm::dmat4> cameraFromWorld;
  PoseCovariance worldCovariance{};
  PoseSource worldSource = PoseSource::kSeen;
  double worldRmsPx = 0.0;             ///< reprojection error of the agreeing tags, when last seen
  double worldRotationSigmaRad = 0.0;  ///< predicted, over all axes
  double worldTranslationSigmaMetres = 0.0;
  TrackingCounters counted;  ///< in this frame
};

struct TrackerOptions {
  TagDetectorOptions detector;
  TargetPoseOptions poses;
  /// Longest time between two searches of the whole image for tags; in between, only the regions of
  /// known tags are searched. Zero: every frame is searched.
  hal::Duration searchPeriod = std::chrono::milliseconds(150);
  /// Shortest edge (px) of a tag whose pose is used. Below this, every eighth pose is the wrong
  /// alternative (docs/measured.md).
  double minEdgePx = 15.0;
};

/// Finds tags and poses frame by frame, in buffers that it keeps. One thread at a time.
class Tracker {
 public:
  /// Without a camera it finds tags but no poses. Throws Failure for an unknown family.
  Tracker(std::optional<CameraModel> camera, std::vector<TagMarker> markers,
          TrackerOptions options = {});

  /// Tracks a frame. Precondition: the frame has the camera's size, if there is a camera.
  TrackingResult track(LumaFrame& frame, hal::TimePoint captureTime);
  /// Tracks an image of any format, under the same precondition.
  TrackingResult track(const hal::ImageView& image, hal::TimePoint captureTime);

  /// Forgets earlier poses, as after a cut.
  void reset();
  const TrackingCounters& counters() const { return counters_; }

 private:
  /// State of a marker, or of the world, kept from frame to frame.
  struct Target {
    TargetPose pose;
    double ambiguityEvidence = kLoneEvidence;
  };
  /// A tag of known size, with its possible poses.
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
  LumaFrame own_;  // for frames that come as images
  SurfaceCorners features_;
  TrackingCounters counters_;
  WorldPoseSolver worldSolver_;
  Target world_;
  std::vector<Target> targets_;  // per marker, while it is not part of the world
  // Per marker: it agreed with the world when it was last seen.
  std::vector<std::uint8_t> isWithWorld_;
  std::vector<std::uint8_t> isSeen_;  // per marker, in the last frame
  std::vector<TagPlane> worldPlanes_;
  std::vector<TagPlane> planes_;
  std::vector<glm::dvec3> worldModel_;           // points where accuracy matters
  std::vector<std::vector<glm::dvec3>> models_;  // per marker
  hal::TimePoint keyMade_;
  std::optional<hal::TimePoint> lastFullSearch_;  // time of the last search of the whole image
  bool isMissing_ = false;                        // an expected tag was missing in the last frame
  std::optional<hal::TimePoint> searchedMirrored_;
  std::vector<std::uint8_t> mirrored_;  // the mirrored image
  std::vector<TrackedTag> tags_;        // of the last frame, as all below
  std::vector<ExpectedTag> expected_;
  std::vector<Sighting> sightings_;
  std::vector<WorldTag> worldTags_;            // sightings with a known place in the world
  std::vector<std::size_t> worldTagSighting_;  // index in sightings_, per world tag
  std::vector<TagCornersPx> keyTags_;
};

/// Checks that a calibration is for frames of this size. The error (kInvalidInput) names both
/// sizes: silent scaling would be wrong for a sensor that crops.
hal::Result<void> checkSize(const CameraModel& camera, hal::FrameSize frame,
                            std::string calibration);

}  // namespace pleinair::tracking
