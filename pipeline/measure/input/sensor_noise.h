#pragma once

#include <cstdint>

#include <opencv2/core.hpp>

#include "hal/image.h"

namespace pleinair::measure {

/// Adds sensor noise to an image: white Gaussian noise of `sigmaLevels` (8-bit levels) on each
/// channel, rounded to RGB8. The noise depends on `seed` only.
hal::Image withSensorNoise(const cv::Mat3f& picture, double sigmaLevels, std::uint64_t seed);

}  // namespace pleinair::measure
