#pragma once

#include <opencv2/core.hpp>

#include "pipeline/measure/input/motion_map.h"
#include "pipeline/measure/mean.h"

namespace pleinair::measure {

/// Persistence of marks, measured in the images alone: the share of an image's corners (Shi and
/// Tomasi, 1994: 300 at most, quality 0.01, 8 px apart) that are found again in a later one, at x +
/// motion(x) ± 1 px, as a patch of 13×13 px whose normalised cross-correlation is above 0.8.
/// Corners that are partly or wholly outside of the later image do not count. Both images are grey.
Mean lastingMarks(const cv::Mat1f& earlier, const Warped<cv::Mat1f>& later);

}  // namespace pleinair::measure
