#pragma once

#include <opencv2/core.hpp>

#include "pipeline/measure/input/motion_map.h"
#include "pipeline/measure/mean.h"

namespace pleinair::measure {

/// Mean (O_t(x) − O_{t+n}(x + n·v))² over all channels, of two pictures or two high passes. As EW2
/// it is told times 1000. Precondition of this and the next two: the pictures have one size.
Mean carriedError(const cv::Mat3f& earlier, const Carried<cv::Mat3f>& later);

/// The share of pixels whose largest channel differs by more than 24/255.
Mean poppedShare(const cv::Mat3f& earlier, const Carried<cv::Mat3f>& later);

/// Where the high pass is laid wrong on purpose, to know what marks that have nothing to do with
/// each other read.
inline constexpr int kMisalignedX = 24;
inline constexpr int kMisalignedY = -16;
/// How far a high pass has looked: two of its Gaussian's σ.
inline constexpr int kHighPassReach = 12;

/// |O_t(x) − O_{t+n}(x + n·v)|, black where nothing is known: for people to look at.
cv::Mat3f differenceAlong(const cv::Mat3f& earlier, const Carried<cv::Mat3f>& later);

}  // namespace pleinair::measure
