#pragma once

#include <optional>
#include <span>

#include "hal/image.h"
#include "pipeline/calibration/board_detector.h"

namespace pleinair::calibration {

/// Sharpness of a board in an image: contrast over steepest slope across its own edges, in pixels;
/// the median over each of the board's two directions, and the larger of the two, since motion
/// blurs one direction only. A Gaussian blur of σ px gives √(2π) σ or more. Returns nothing where
/// no edge between `corners` (by rising id) has contrast.
std::optional<double> edgeWidth(const hal::PlaneView& luma, hal::FrameSize size, const Board& board,
                                std::span<const SightedCorner> corners);

}  // namespace pleinair::calibration
