#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "pipeline/calibration/lens_fit.h"

namespace pleinair::calibration {

/// The chosen lens model, fitted to the views that agree.
struct LensChoice {
  LensFit fit;
  /// Cross-validation error: the lens is fitted to four fifths of the views and the poses of the
  /// rest are fitted under it, five times.
  double heldOutRmsPx = 0.0;
  std::vector<FitView> used;           ///< without rejected views and points
  std::vector<std::size_t> usedViews;  ///< indices of these among all views, rising
  std::size_t rejectedPoints = 0;      ///< in used views
};

inline constexpr std::size_t kMinFittedViews = 6;

/// Fits robustly, rejects views and points that disagree with the others, and chooses the simplest
/// lens model whose held-out error is within 2 % (of its square) of the best. Terms that the views
/// do not need would distort the image where no view was. Returns nothing where fewer than
/// kMinFittedViews agree.
std::optional<LensChoice> chooseLens(std::span<const FitView> views, hal::FrameSize size);

}  // namespace pleinair::calibration
