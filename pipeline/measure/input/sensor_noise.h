#pragma once

#include <cstdint>

#include <opencv2/core.hpp>

#include "hal/image.h"

namespace pleinair::measure {

/// The picture as a sensor gives it: white Gaussian noise of `sigmaLevels` (8-bit levels) on each
/// channel, rounded to RGB8. The same for the same `seed`; another one for each other.
hal::Image withSensorNoise(const cv::Mat3f& picture, double sigmaLevels, std::uint64_t seed);

}  // namespace pleinair::measure
