#pragma once

#include <optional>
#include <span>

#include "hal/image.h"
#include "pipeline/calibration/board_detector.h"

namespace pleinair::calibration {

/// How sharp a board is seen: contrast over steepest slope across its own edges, in pixels, the
/// median of each of the board's two directions, and the larger of those, since motion blurs one
/// direction only. A Gaussian blur of σ px gives √(2π) σ and more. Nothing where no edge between
/// `corners` (by rising id) has contrast.
std::optional<double> edgeWidth(const hal::PlaneView& luma, hal::FrameSize size, const Board& board,
                                std::span<const SightedCorner> corners);

}  // namespace pleinair::calibration
