#pragma once

#include <opencv2/core.hpp>

#include "pipeline/measure/input/motion_map.h"

namespace pleinair::measure {

/// The motion between two images, for inputs whose true motion is not known: dense inverse search
/// (Kroeger et al., 2016) at full resolution in both directions. Valid where they agree within a
/// pixel. It is independent of the painter's own estimate.
MotionMap denseMotion(const cv::Mat3b& earlier, const cv::Mat3b& later);

/// The same before a camera that stands, where the masks of what moves are known (255): beside a
/// mover dense motion is the mover's in part, but nothing moves there. Valid where both images show
/// the same side of a mover's border, and not close to it.
MotionMap standingMotion(const cv::Mat3b& earlier, const cv::Mat3b& later,
                         const cv::Mat1b& earlierMovers, const cv::Mat1b& laterMovers);

}  // namespace pleinair::measure
