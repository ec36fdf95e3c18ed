#pragma once

#include <array>
#include <functional>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>

#include "pipeline/tracking/pose/tracker.h"
#include "tests/reports/tracking/truth_sequence.h"

namespace pleinair::tracking {

/// How a sequence's tags are described in a tracker's scene.
enum class Layout {
  kWorld,  ///< with their places in the world
  kLoose   ///< each by itself, with only its size known
};

/// A tracker's result for one frame.
struct TrackedPoses {
  std::optional<glm::dmat4> cameraFromWorld;
  PoseCovariance worldCovariance{};
  std::map<int, TrackedTag> tags;  ///< those with a pose
};

/// Edits an image before it is tracked; `index` is the frame's index in its sequence.
using Retouch = std::function<void(const TruthFrame& frame, std::size_t index, hal::Image& luma)>;

/// Tracks every frame of a sequence.
std::vector<TrackedPoses> trackAll(const TruthSequence& sequence, Layout layout,
                                   const TrackerOptions& options = {}, const Retouch& retouch = {});

/// The eight corners of a cube that stands on a tag, in the tag's frame: sample points of a model.
std::array<glm::dvec3, 8> modelPoints(double edgeMetres);
/// The image positions of modelPoints().
using ModelPx = std::array<glm::dvec2, 8>;
ModelPx modelPx(const CameraModel& camera, const glm::dmat4& cameraFromTag, double edgeMetres);

/// Root mean square distance of two models' points.
double rmsBetween(const ModelPx& a, const ModelPx& b);

/// The estimated and the true pose of a tag in one frame, compared by the image of a model on it.
struct ModelError {
  double rotationDegrees = 0.0;
  double translationMm = 0.0;
  double px = 0.0;  ///< RMS over modelPoints()
};
ModelError modelError(const TruthSequence& sequence, std::size_t frame, int id,
                      const glm::dmat4& cameraFromTag);

/// RMS error in px of a model's points, over all visible tags with a pose from `source`.
struct PredictedErrors {
  double actualPx = 0.0;
  double predictedPx = 0.0;  ///< from the poses' covariances
};
PredictedErrors predictedErrors(const TruthSequence& sequence, std::span<const TrackedPoses> told,
                                PoseSource source = PoseSource::kSeen);

/// The percentile `part` (0 … 1) of the values; NaN without values.
double percentile(std::vector<double> values, double part);
double rootMeanSquare(std::span<const double> values);

/// The jitter of a model in front of a static camera (RMS px).
struct Tremble {
  double aboutMean = 0.0;
  double frameToFrame = 0.0;
};
/// Over the frames from `firstFrame` on in which the tag has a pose.
Tremble trembleOf(const TruthSequence& sequence, std::span<const TrackedPoses> told, int id,
                  std::size_t firstFrame);

/// The model's lag behind the truth, ms: the shift of the true path, interpolated between frames,
/// that fits the estimates best. Over the frames in which the tag has a pose.
double lagMs(const TruthSequence& sequence, std::span<const TrackedPoses> told, int id);

/// Tags that are covered periodically.
struct Hiding {
  std::size_t firstFrame = 30;
  std::size_t hiddenFrames = 6;
  std::size_t everyFrames = 45;
  /// 1: the tag with its white border; 0.5: its right half.
  double part = 1.0;

  /// Whether the tags are covered in a frame.
  bool hides(std::size_t frame) const {
    return frame >= firstFrame && (frame - firstFrame) % everyFrames < hiddenFrames;
  }
};
/// Covers one tag (`onlyId`) or all tags in the image with grey.
Retouch hidden(const Hiding& hiding, std::optional<int> onlyId = std::nullopt);

/// The behaviour of a model while its tag was hidden, over all intervals with a visible tag before
/// and after.
struct HiddenResult {
  std::size_t times = 0;
  std::size_t framesHidden = 0;
  std::size_t framesLost = 0;    ///< without a pose
  std::vector<double> driftPx;   ///< for each interval: its largest error minus the error before it
  std::vector<double> jumpPx;    ///< largest frame-to-frame change of the error at each return
  std::vector<double> settlePx;  ///< error 10 frames after each return
};
/// Jumps are searched in the first frame after an interval and the five frames after that.
HiddenResult hiddenResult(const TruthSequence& sequence, std::span<const TrackedPoses> told, int id,
                          const Hiding& hiding);

}  // namespace pleinair::tracking
