#pragma once

#include <opencv2/core.hpp>

#include "pipeline/measure/input/motion_map.h"

namespace pleinair::measure {

/// The motion between two images, for inputs whose true motion is not known: dense inverse search
/// (Kroeger et al., 2016) at full resolution in both directions. Valid where they agree within a
/// pixel. It is independent of the painter's own estimate.
MotionMap denseMotion(const cv::Mat3b& earlier, const cv::Mat3b& later);

}  // namespace pleinair::measure
