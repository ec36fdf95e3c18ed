#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "pipeline/calibration/lens_fit.h"

namespace pleinair::calibration {

/// A lens model that the views speak for, fitted to those that agree.
struct LensChoice {
  LensFit fit;
  /// Of views that had no part in the fit: it is fitted to four fifths of the views, the rest are
  /// posed under it, five times.
  double heldOutRmsPx = 0.0;
  std::vector<FitView> used;           ///< without what was rejected
  std::vector<std::size_t> usedViews;  ///< which of all views those are, rising
  std::size_t rejectedPoints = 0;      ///< of used views
};

inline constexpr std::size_t kFewestFittedViews = 6;

/// Fits robustly, rejects views and points that disagree with the others, and takes the simplest
/// lens model whose held-out error is within 2 % (of its square) of the best: terms that the views
/// do not need would bend the picture where no view was. Nothing where fewer than
/// kFewestFittedViews hold together.
std::optional<LensChoice> chooseLens(std::span<const FitView> views, hal::FrameSize size);

}  // namespace pleinair::calibration
