#pragma once

#include <opencv2/core.hpp>

#include "pipeline/measure/mean.h"

namespace pleinair::measure {

/// Mean square of O − J within the border, where J is I with the best gain and offset per channel
/// (least squares): the distance of a painting from the photograph, apart from a tone curve. DEP is
/// 255 times its root.
Mean deviation(const cv::Mat3f& output, const cv::Mat3f& input);

/// Mean square within the border; of a high pass it is the amount of detail.
Mean meanSquare(const cv::Mat3f& picture);

/// Sum of absolute differences of two frames within the border, over all channels: flicker if
/// nothing moves.
Mean absoluteDifference(const cv::Mat3f& a, const cv::Mat3f& b);

}  // namespace pleinair::measure
