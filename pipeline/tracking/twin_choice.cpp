#include "pipeline/tracking/twin_choice.h"

#include <algorithm>
#include <cassert>

#include "pipeline/tracking/pose_refinement.h"

namespace pleinair::tracking {
namespace {

/// Noise of a refined corner that is assumed at the least, and by how many variances of it the
/// squared errors have to differ (a log-likelihood ratio of half that).
constexpr double kCornerNoisePx = 0.2;
constexpr double kClearDifference = 16.0;

bool isClear(double better, double worse, double residualFreedom) {
  const double variance = std::max(kCornerNoisePx * kCornerNoisePx, better / residualFreedom);
  return worse - better > kClearDifference * variance;
}

}  // namespace

TwinDecision chooseTwin(std::span<const TwinCandidate> candidates, double residualFreedom,
                        const std::optional<PosePrior>& prior) {
  assert(!candidates.empty() && residualFreedom > 0.0);
  if (candidates.size() == 1) return {.index = 0, .choice = TwinChoice::kOnly};
  if (isClear(candidates[0].squaredErrorPx, candidates[1].squaredErrorPx, residualFreedom)) {
    return {.index = 0, .choice = TwinChoice::kByError};
  }
  if (!prior) return {.index = 0, .choice = TwinChoice::kAmbiguous};
  const double toFirst =
      rotationBetweenRad(candidates[0].cameraFromTarget, prior->cameraFromTarget);
  const double toSecond =
      rotationBetweenRad(candidates[1].cameraFromTarget, prior->cameraFromTarget);
  return {.index = toFirst <= toSecond ? std::size_t{0} : std::size_t{1},
          .choice = prior->isTrusted ? TwinChoice::kByPrior : TwinChoice::kAmbiguous};
}

}  // namespace pleinair::tracking
