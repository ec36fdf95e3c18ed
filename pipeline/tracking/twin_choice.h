#pragma once

#include <cstddef>
#include <optional>
#include <span>

#include <glm/mat4x4.hpp>

namespace pleinair::tracking {

/// How one of the two poses was chosen that a plane's picture allows: seen from near the front or
/// from afar, a tag and its mirror image through the line of sight look alike.
enum class TwinChoice {
  kOnly,      ///< there was but one
  kByError,   ///< it fits the corners clearly better
  kByPrior,   ///< it agrees with a known pose: other tags' or the previous frame's
  kAmbiguous  ///< nothing told them apart: the better fit, or what was guessed before
};

/// A pose known from elsewhere. Not trusted: a guess that is kept only so as not to flicker.
struct PosePrior {
  glm::dmat4 cameraFromTarget{1.0};
  bool isTrusted = true;
};

/// One of the poses to choose from.
struct TwinCandidate {
  glm::dmat4 cameraFromTarget{1.0};
  double squaredErrorPx = 0.0;  ///< sum over all corners, px²
};

struct TwinDecision {
  std::size_t index = 0;
  TwinChoice choice = TwinChoice::kOnly;
};

/// Chooses among one or two candidates, sorted by rising error. The error decides where its
/// difference is many times what the corners' noise makes; else the prior nearest in rotation;
/// `residualFreedom` is twice the number of corners, less six.
TwinDecision chooseTwin(std::span<const TwinCandidate> candidates, double residualFreedom,
                        const std::optional<PosePrior>& prior);

}  // namespace pleinair::tracking
