#pragma once

#include <opencv2/core.hpp>

#include "pipeline/measure/mean.h"

namespace pleinair::measure {

/// The mean square of O − J within the border, with J the best gain and offset of each channel of
/// I (least squares): how far a painting is from the photograph, a tone curve not counted. DEP is
/// its root, times 255.
Mean deviation(const cv::Mat3f& output, const cv::Mat3f& input);

/// The mean square within the border: of a high pass, the detail there is.
Mean meanSquare(const cv::Mat3f& picture);

/// The sum of absolute differences of two frames within the border, over all channels: flicker,
/// where nothing moves.
Mean absoluteDifference(const cv::Mat3f& a, const cv::Mat3f& b);

}  // namespace pleinair::measure
