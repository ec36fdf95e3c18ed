#include "pipeline/tracking/pose/pose_ambiguity.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "pipeline/tracking/pose/pose_refinement.h"

namespace pleinair::tracking {
namespace {

/// Least assumed noise of a refined corner.
constexpr double kCornerNoisePx = 0.2;
/// Part of earlier evidence that is kept: errors of neighbouring frames are not independent.
constexpr double kRemembered = 0.9;

/// Evidence for the better of two fits.
double evidenceOf(double better, double worse, double residualFreedom) {
  const double variance = std::max(kCornerNoisePx * kCornerNoisePx, better / residualFreedom);
  return (worse - better) / variance;
}

/// The prior's evidence for the first candidate; negative if it favours the second.
double priorEvidence(std::span<const PoseCandidate> candidates, const PosePrior& prior) {
  const double toFirst = rotationBetweenRad(candidates[0].cameraFromTarget, prior.cameraFromTarget);
  const double toSecond =
      rotationBetweenRad(candidates[1].cameraFromTarget, prior.cameraFromTarget);
  return (toFirst <= toSecond ? kRemembered : -kRemembered) * prior.evidence;
}

}  // namespace

AmbiguityDecision resolveAmbiguity(std::span<const PoseCandidate> candidates,
                                   double residualFreedom, const std::optional<PosePrior>& prior) {
  assert(!candidates.empty() && residualFreedom > 0.0);
  if (candidates.size() == 1) return {};
  const double fromError =
      evidenceOf(candidates[0].squaredErrorPx, candidates[1].squaredErrorPx, residualFreedom);
  if (fromError >= kClearEvidence) {
    return {.index = 0,
            .choice = AmbiguityResolution::kByError,
            .evidence = std::min(fromError, kFullEvidence)};
  }
  const double total = prior ? fromError + priorEvidence(candidates, *prior) : fromError;
  const double evidence = std::min(std::abs(total), kFullEvidence);
  return {.index = total >= 0.0 ? std::size_t{0} : std::size_t{1},
          .choice = evidence >= kClearEvidence ? AmbiguityResolution::kByPrior
                                               : AmbiguityResolution::kAmbiguous,
          .evidence = evidence};
}

}  // namespace pleinair::tracking
