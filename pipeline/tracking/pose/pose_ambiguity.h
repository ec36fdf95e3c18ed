#pragma once

#include <cstddef>
#include <optional>
#include <span>

#include <glm/mat4x4.hpp>

namespace pleinair::tracking {

/// How the planar pose ambiguity was resolved: seen from near the front or from afar, a tag and its
/// mirror image through the line of sight look alike, so the image allows two poses.
enum class AmbiguityResolution {
  kOnly,      ///< there was one pose only
  kByError,   ///< this pose fits the corners clearly better
  kByPrior,   ///< clear together with other tags or earlier frames
  kAmbiguous  ///< the likelier pose, but not clearly so
};

/// Evidence is the difference of two poses' squared errors in variances of a corner's noise (twice
/// a log-likelihood ratio). A choice is clear from kClearEvidence on; evidence is capped at
/// kFullEvidence, so that a mistake is unlearnt in time.
inline constexpr double kClearEvidence = 16.0;
inline constexpr double kFullEvidence = 32.0;
/// Evidence for a pose without an alternative: noise may have merged the two.
inline constexpr double kLoneEvidence = 8.0;

/// A pose known from another source, and the evidence for it against its alternative.
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
  /// For the chosen pose, including the prior's; the evidence of the next prior.
  double evidence = kLoneEvidence;
};

/// Chooses among one or two candidates, sorted by rising error. Clearly different errors decide by
/// themselves. Otherwise their evidence is added to the prior's, which favours the candidate
/// nearest in rotation and decays by a tenth each time. So frames that contradict a first guess
/// overrule it, and many frames decide what one cannot. `residualFreedom` is twice the number of
/// corners, less six.
AmbiguityDecision resolveAmbiguity(std::span<const PoseCandidate> candidates,
                                   double residualFreedom, const std::optional<PosePrior>& prior);

}  // namespace pleinair::tracking
