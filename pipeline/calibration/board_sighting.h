#pragma once

#include <optional>
#include <span>
#include <vector>

#include "hal/image.h"
#include "pipeline/calibration/board_detector.h"

namespace pleinair::calibration {

/// Refines corners to a fraction of a pixel (cv::cornerSubPix, in a window of 2 · windowHalf + 1
/// px). Removes corners that are too close to the image's border, leave their window, or are not a
/// crossing of two black and two white areas. The image is first blurred by `softeningPx` (σ; 0:
/// not at all), because cornerSubPix is biased on very sharp edges.
void refineCorners(const hal::PlaneView& luma, hal::FrameSize size, int windowHalf,
                   double softeningPx, std::vector<SightedCorner>& corners);

/// Sharpness of a board in an image: contrast over steepest slope across its own edges, in pixels;
/// the median over each of the board's two directions, and the larger of the two, since motion
/// blurs one direction only. A Gaussian blur of σ px gives √(2π) σ or more. Returns nothing where
/// no edge between `corners` (by rising id) has contrast.
std::optional<double> edgeWidth(const hal::PlaneView& luma, hal::FrameSize size, const Board& board,
                                std::span<const SightedCorner> corners);

}  // namespace pleinair::calibration
