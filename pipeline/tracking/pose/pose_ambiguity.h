#pragma once

#include <cstddef>
#include <optional>
#include <span>

#include <glm/mat4x4.hpp>

namespace pleinair::tracking {

/// How one of the two poses was chosen that a plane's picture allows: seen from near the front or
/// from afar, a tag and its mirror image through the line of sight look alike.
enum class AmbiguityResolution {
  kOnly,      ///< there was but one
  kByError,   ///< it fits the corners clearly better
  kByPrior,   ///< together with what other tags or earlier frames say, it is clearly the one
  kAmbiguous  ///< the likelier one, but not clearly
};

/// Evidence counts by how many variances of a corner's noise the squared errors of two poses differ
/// (twice a log-likelihood ratio). From kClearEvidence on a choice is clear; more than
/// kFullEvidence is not kept, so that a mistake is unlearnt in time.
inline constexpr double kClearEvidence = 16.0;
inline constexpr double kFullEvidence = 32.0;
/// For a pose that had no alternative: noise may have merged the two.
inline constexpr double kLoneEvidence = 8.0;

/// A pose known from elsewhere, and how surely it is not the alternative.
struct PosePrior {
  glm::dmat4 cameraFromTarget{1.0};
  double evidence = kFullEvidence;
};

/// One of the poses to choose from.
struct PoseCandidate {
  glm::dmat4 cameraFromTarget{1.0};
  double squaredErrorPx = 0.0;  ///< sum over all corners, px²
};

struct AmbiguityDecision {
  std::size_t index = 0;
  AmbiguityResolution choice = AmbiguityResolution::kOnly;
  double evidence = kLoneEvidence;  ///< for the chosen one, the prior's included: a next prior
};

/// Chooses among one or two candidates, sorted by rising error. Errors that differ clearly decide
/// by themselves; else their evidence is added to the prior's, which speaks for the candidate
/// nearest in rotation and is forgotten by a tenth each time. So a first guess gives way to frames
/// that contradict it, and many frames make clear what one cannot. `residualFreedom` is twice the
/// number of corners, less six.
AmbiguityDecision resolveAmbiguity(std::span<const PoseCandidate> candidates,
                                   double residualFreedom, const std::optional<PosePrior>& prior);

}  // namespace pleinair::tracking
