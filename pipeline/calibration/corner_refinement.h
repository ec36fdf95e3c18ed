#pragma once

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

}  // namespace pleinair::calibration
