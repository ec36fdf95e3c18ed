#pragma once

#include <opencv2/core.hpp>

#include "pipeline/measure/input/motion_map.h"
#include "pipeline/measure/mean.h"

namespace pleinair::measure {

/// Mean (O_t(x) − O_{t+n}(x + n·v))² over all channels, of two images or two high passes. EW2 is
/// 1000 times this. Precondition of this and the next two functions: the images have one size.
Mean warpingError(const cv::Mat3f& earlier, const Warped<cv::Mat3f>& later);

/// Share of pixels whose largest channel differs by more than 24/255.
Mean poppedShare(const cv::Mat3f& earlier, const Warped<cv::Mat3f>& later);

/// Deliberate displacement of the high pass, to measure the reading of unrelated marks.
inline constexpr int kMisalignedX = 24;
inline constexpr int kMisalignedY = -16;
/// Radius of the high pass: two σ of its Gaussian.
inline constexpr int kHighPassReach = 12;

/// |O_t(x) − O_{t+n}(x + n·v)|, black where nothing is known; for people to look at.
cv::Mat3f differenceAlong(const cv::Mat3f& earlier, const Warped<cv::Mat3f>& later);

}  // namespace pleinair::measure
