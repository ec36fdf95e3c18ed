#pragma once

#include <cstdint>
#include <optional>

#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

#include "hal/clock.h"
#include "pipeline/overlay/overlay_content.h"
#include "pipeline/tracking/camera/camera_model.h"
#include "pipeline/tracking/pose/pose_refinement.h"

namespace pleinair::overlay {

/// Predicted error of a point in the image (px, one standard deviation over both axes) where the
/// pose has this covariance about `turnsAbout`. Points are in the camera's frame, metres; infinite
/// behind the camera.
double predictedErrorPx(const tracking::CameraModel& camera,
                        const tracking::PoseCovariance& covariance, const glm::dvec3& turnsAbout,
                        const glm::dvec3& point);

/// What is known of a machine's pose in one frame.
struct PoseEvidence {
  bool hasPose = false;
  bool isSeen = false;            ///< a tag of the machine was seen in this frame
  bool seesOtherMachine = false;  ///< OtherMachine::update()
  bool isContradicted = false;    ///< TagContradictions::update()
  bool isOutOfView = false;       ///< all of the step's parts are beside the picture
  double errorPx = 0.0;           ///< predictedErrorPx() at the worst of the step's parts
  double partPx = 0.0;            ///< extent of the smallest of them in the image
  double pxScale = 1.0;           ///< px of the image per px of one that is 640 px wide
};

/// How far the overlay is to be shown.
struct Trust {
  float opacity = 0.0F;  ///< of what is on the machine
  Doubt doubt = Doubt::kNotSeen;
  bool standsIn = false;  ///< the inset and a badge are to stand in for it
};

/// Decides from frame to frame how far a machine's overlay may be shown. It is hidden at once and
/// comes back slowly: an instruction on the wrong part is worse than none. Deterministic in the
/// frames' times; one thread.
class PoseTrust {
 public:
  Trust update(const PoseEvidence& evidence, hal::TimePoint now);
  /// As after a cut.
  void reset() { *this = PoseTrust(); }

 private:
  Doubt doubtOf(const PoseEvidence& evidence, hal::TimePoint now);

  std::optional<hal::TimePoint> last_;
  std::optional<hal::TimePoint> seen_;     ///< a tag of the machine
  std::optional<hal::TimePoint> doubted_;  ///< since when without a break
  double opacity_ = 0.0;
  bool standsIn_ = true;
  Doubt doubt_ = Doubt::kNotSeen;
};

}  // namespace pleinair::overlay
