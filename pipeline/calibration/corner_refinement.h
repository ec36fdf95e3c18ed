#pragma once

#include <vector>

#include "hal/image.h"
#include "pipeline/calibration/board_detector.h"

namespace pleinair::calibration {

/// Moves corners to where black and white meet, to a fraction of a pixel (cv::cornerSubPix, in a
/// window of 2 · windowHalf + 1 px). Those too near to the picture's border, those that leave their
/// window, and those where no two black and two white fields meet, are taken out. The picture is
/// blurred by `softeningPx` (σ; 0: not) before: cornerSubPix is biased on edges as sharp as pixels.
void refineCorners(const hal::PlaneView& luma, hal::FrameSize size, int windowHalf,
                   double softeningPx, std::vector<SightedCorner>& corners);

}  // namespace pleinair::calibration
