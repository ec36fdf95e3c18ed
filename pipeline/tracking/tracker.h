#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <glm/mat4x4.hpp>

#include "hal/clock.h"
#include "hal/image.h"
#include "pipeline/tracking/camera_model.h"
#include "pipeline/tracking/luma.h"
#include "pipeline/tracking/tag_detector.h"
#include "pipeline/tracking/tag_marker.h"
#include "pipeline/tracking/tag_pose.h"
#include "pipeline/tracking/twin_choice.h"
#include "pipeline/tracking/world_pose.h"

namespace pleinair::tracking {

struct TrackedTag {
  int id = 0;
  TagCornersPx corners{};  ///< px of the frame, pixel centres at +0.5, tagCorners()' order
  /// Where the tag's size and the camera are known. That of the world where the tag agrees with it.
  std::optional<glm::dmat4> cameraFromTag;
  PoseCovariance covariance{};            ///< of cameraFromTag
  TwinChoice choice = TwinChoice::kOnly;  ///< how the pose's twin was rejected
};

/// What was not used, by reason; sums over a Tracker's life.
struct TrackingCounters {
  DetectionCounters detection;
  std::uint32_t degenerateTags = 0;     ///< corners that allow no pose
  std::uint32_t ambiguousTags = 0;      ///< nothing told the pose from its twin
  std::uint32_t contradictingTags = 0;  ///< not where the other tags put them
};

struct TrackingResult {
  /// By rising id, each id once; the Tracker's, valid until its next track().
  std::span<const TrackedTag> tags;
  std::optional<glm::dmat4> cameraFromWorld;
  PoseCovariance worldCovariance{};
  double worldRmsPx = 0.0;             ///< reprojection error of the tags that agree
  double worldRotationSigmaRad = 0.0;  ///< predicted, over all axes
  double worldTranslationSigmaMetres = 0.0;
};

struct TrackerOptions {
  TagDetectorOptions detector;
  /// A pose seen longer ago does not help to reject a twin.
  hal::Duration memory = std::chrono::milliseconds(500);
};

/// Finds tags and poses, frame by frame, in buffers that it keeps. One thread at a time.
class Tracker {
 public:
  /// Without a camera it finds tags and no poses. Throws StartupError for an unknown family.
  Tracker(std::optional<CameraModel> camera, std::vector<TagMarker> markers,
          TrackerOptions options = {});

  /// Tracks a frame of any format. Precondition: the camera's size, if there is one.
  TrackingResult track(const hal::ImageView& image, hal::TimePoint captureTime);

  /// Forgets earlier poses, as after a cut.
  void reset();
  const TrackingCounters& counters() const { return counters_; }

 private:
  struct Remembered {
    glm::dmat4 cameraFromTarget{1.0};
    hal::TimePoint seen;
    double twinEvidence = kLoneEvidence;
  };
  /// A tag whose size is known, with its possible poses.
  struct Sighting {
    std::size_t marker = 0;  // in markers_
    std::size_t tag = 0;     // in tags_
    PoseCandidates candidates;
    bool agrees = false;  // with the world
  };

  void findSightings();
  void solveWorld(hal::TimePoint now, TrackingResult& result);
  void solveTag(const Sighting& sighting, hal::TimePoint now, const TrackingResult& result);
  std::optional<PosePrior> prior(const Remembered& remembered, hal::TimePoint now) const;

  std::optional<CameraModel> camera_;
  std::vector<TagMarker> markers_;
  TrackerOptions options_;
  TagDetector detector_;
  LumaConverter luma_;
  TrackingCounters counters_;
  WorldPoseSolver worldSolver_;
  std::optional<Remembered> world_;
  std::vector<std::optional<Remembered>> remembered_;  // of each marker
  std::vector<TrackedTag> tags_;                       // of the last frame, as all below
  std::vector<Sighting> sightings_;
  std::vector<WorldTag> worldTags_;            // the sightings with a place in the world
  std::vector<std::size_t> worldTagSighting_;  // of each, in sightings_
};

/// Whether a calibration is for frames of this size, else an error (kInvalidInput) that names both:
/// scaling it in silence would be wrong for a sensor that crops.
hal::Result<void> checkSize(const CameraModel& camera, hal::FrameSize frame,
                            std::string calibration);

}  // namespace pleinair::tracking
