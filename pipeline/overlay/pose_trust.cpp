#include "pipeline/overlay/pose_trust.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>

#include <glm/mat3x3.hpp>

#include "pipeline/tracking/pose/twist.h"

namespace pleinair::overlay {
namespace {

using namespace std::chrono_literals;

// Limits of the predicted error, one standard deviation, for an image 640 px wide.
constexpr double kMostErrorPx = 1.6;
constexpr double kLeastErrorPx = 0.7;  ///< that small parts are allowed all the same
constexpr double kShareOfPart = 0.15;
/// From this share of the limit on the overlay fades.
constexpr double kFadesFrom = 0.75;

/// As long as tracking carries a pose; its predicted error grows meanwhile.
constexpr hal::Duration kCarriedFor = 500ms;
constexpr hal::Duration kFadesIn = 100ms;
/// A pose that is lost for a frame or two does not bring the inset.
constexpr hal::Duration kStandsInAfter = 350ms;

}  // namespace

std::string_view nameOf(Doubt doubt) {
  switch (doubt) {
    case Doubt::kNone:
      return "none";
    case Doubt::kNotSeen:
      return "not seen";
    case Doubt::kCarried:
      return "carried";
    case Doubt::kUncertain:
      return "uncertain";
    case Doubt::kOutOfView:
      return "out of view";
    case Doubt::kOtherMachine:
      return "other machine";
    case Doubt::kContradicted:
      return "contradicted";
  }
  return {};
}

double predictedErrorPx(const tracking::CameraModel& camera,
                        const tracking::PoseCovariance& covariance, const glm::dvec3& turnsAbout,
                        const glm::dvec3& point) {
  if (point.z <= 0.0) return std::numeric_limits<double>::infinity();
  const tracking::PoseCovariance there = tracking::atPoint(covariance, point - turnsAbout);
  glm::dmat3 shift;
  for (int column = 0; column < 3; ++column) {
    for (int row = 0; row < 3; ++row) {
      shift[column][row] = there.at(static_cast<std::size_t>(6 * (3 + row) + 3 + column));
    }
  }
  const glm::dmat3x2 jacobian = camera.projectWithJacobian(point).pxByCameraPoint;
  const glm::dmat2 spread = jacobian * shift * glm::transpose(jacobian);
  return std::sqrt(std::max(0.0, spread[0][0] + spread[1][1]));
}

Doubt PoseTrust::doubtOf(const PoseEvidence& evidence, hal::TimePoint now) {
  if (evidence.hasPose && evidence.isSeen) seen_ = now;
  if (!evidence.isSeen && evidence.seesOtherMachine) return Doubt::kOtherMachine;
  if (!evidence.hasPose) return Doubt::kNotSeen;
  if (!seen_ || now - *seen_ > kCarriedFor) return Doubt::kCarried;
  if (evidence.isContradicted) return Doubt::kContradicted;
  if (evidence.isOutOfView) return Doubt::kOutOfView;
  return Doubt::kNone;
}

Trust PoseTrust::update(const PoseEvidence& evidence, hal::TimePoint now) {
  Doubt doubt = doubtOf(evidence, now);
  double allowed = doubt == Doubt::kNone ? 1.0 : 0.0;
  if (doubt == Doubt::kNone) {
    const double limit =
        evidence.pxScale *
        std::clamp(kShareOfPart * evidence.partPx / evidence.pxScale, kLeastErrorPx, kMostErrorPx);
    allowed = std::clamp((1.0 - evidence.errorPx / limit) / (1.0 - kFadesFrom), 0.0, 1.0);
    if (allowed == 0.0) doubt = Doubt::kUncertain;
  }
  const double elapsed = last_ ? std::max(0.0, hal::toSeconds(now - *last_)) : 0.0;
  // A beginning is no return: there is nothing to fade in from.
  opacity_ = last_ ? std::min(allowed, opacity_ + elapsed / hal::toSeconds(kFadesIn)) : allowed;
  last_ = now;
  if (doubt == Doubt::kNone) {
    doubted_.reset();
    if (opacity_ >= 0.99) standsIn_ = false;
  } else {
    if (!doubted_) doubted_ = now;
    if (now - *doubted_ >= kStandsInAfter) standsIn_ = true;
  }
  if (doubt != Doubt::kNone) doubt_ = doubt;  // the badge keeps its reason until it goes
  return {.opacity = static_cast<float>(opacity_),
          .doubt = doubt == Doubt::kNone && !standsIn_ ? Doubt::kNone : doubt_,
          .standsIn = standsIn_};
}

}  // namespace pleinair::overlay
