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

/// How a sequence's tags are put into a tracker's scene.
enum class Layout {
  kWorld,  ///< with their places in the world
  kLoose   ///< each by itself: only its size is known
};

/// What a tracker said of one frame.
struct Told {
  std::optional<glm::dmat4> cameraFromWorld;
  PoseCovariance worldCovariance{};
  std::map<int, TrackedTag> tags;  ///< those with a pose
};

/// Changes a picture before it is tracked: `index` is the frame's in its sequence.
using Retouch = std::function<void(const TruthFrame& frame, std::size_t index, hal::Image& luma)>;

/// Tracks every frame of a sequence.
std::vector<Told> trackAll(const TruthSequence& sequence, Layout layout,
                           const TrackerOptions& options = {}, const Retouch& retouch = {});

/// The eight corners of a cube that stands on a tag, in its frame: what a model's points do.
std::array<glm::dvec3, 8> modelPoints(double edgeMetres);
/// Where a lens shows them.
using ModelPx = std::array<glm::dvec2, 8>;
ModelPx modelPx(const CameraModel& camera, const glm::dmat4& cameraFromTag, double edgeMetres);

/// Root mean square distance of two models' points.
double rmsBetween(const ModelPx& a, const ModelPx& b);

/// The drawn and the true pose of a tag in one frame, as the picture shows a model on it.
struct ModelError {
  double rotationDegrees = 0.0;
  double translationMm = 0.0;
  double px = 0.0;  ///< RMS over modelPoints()
};
ModelError modelError(const TruthSequence& sequence, std::size_t frame, int id,
                      const glm::dmat4& cameraFromTag);

/// RMS px of a model's points, over all visible tags with a pose from `source`.
struct PredictedErrors {
  double actualPx = 0.0;
  double predictedPx = 0.0;  ///< by the poses' covariances
};
PredictedErrors predictedErrors(const TruthSequence& sequence, std::span<const Told> told,
                                PoseSource source = PoseSource::kSeen);

/// What stands at `part` (0 … 1) of the sorted values; not a number of none.
double percentile(std::vector<double> values, double part);
double rootMeanSquare(std::span<const double> values);

/// How a model trembles before a camera that stands still (RMS px).
struct Tremble {
  double aboutMean = 0.0;
  double frameToFrame = 0.0;
};
/// Over the frames from `firstFrame` on in which the tag has a pose.
Tremble trembleOf(const TruthSequence& sequence, std::span<const Told> told, int id,
                  std::size_t firstFrame);

/// By how many ms the model comes after the truth: the shift of the true path, interpolated between
/// frames, that fits what was told best. Over the frames in which the tag has a pose.
double lagMs(const TruthSequence& sequence, std::span<const Told> told, int id);

/// Tags covered for a while, again and again.
struct Hiding {
  std::size_t firstFrame = 30;
  std::size_t hiddenFrames = 6;
  std::size_t everyFrames = 45;
  /// 1: the tag with its white border; 0.5: the half of it at its right.
  double part = 1.0;

  /// Whether a frame's tags are covered.
  bool hides(std::size_t frame) const {
    return frame >= firstFrame && (frame - firstFrame) % everyFrames < hiddenFrames;
  }
};
/// Covers the tags in the picture by grey, one (`onlyId`) or all.
Retouch hidden(const Hiding& hiding, std::optional<int> onlyId = std::nullopt);

/// What a model did while its tag was hidden, over all times that it was visible before and after.
struct HiddenResult {
  std::size_t times = 0;
  std::size_t framesHidden = 0;
  std::size_t framesLost = 0;    ///< without a pose
  std::vector<double> driftPx;   ///< the largest error of each time, less the one before
  std::vector<double> jumpPx;    ///< largest frame-to-frame change of the error at each return
  std::vector<double> settlePx;  ///< error 10 frames after each return
};
/// Jumps are looked for in the frame of the return and the five after it.
HiddenResult hiddenResult(const TruthSequence& sequence, std::span<const Told> told, int id,
                          const Hiding& hiding);

}  // namespace pleinair::tracking
