#pragma once

#include <cstdint>

#include <opencv2/core.hpp>

#include "hal/image.h"

namespace pleinair::measure {

/// Pixels within this distance of the border are ignored (docs/measuring.md).
inline constexpr int kBorderPixels = 40;
/// Frames with a smaller side are not measured: too little would remain.
inline constexpr int kMinSidePixels = 160;

/// Converts to RGB in [0, 1]. Precondition: the image is RGB8.
cv::Mat3f toFloat(const hal::ImageView& rgb8);
/// Copies 8-bit levels: three channels of RGB8, one of grey. Precondition: the image is either.
cv::Mat toLevels(const hal::ImageView& image);
/// Converts back to RGB8, rounded and clamped.
hal::Image toImage(const cv::Mat3f& picture);

/// Luma (BT.601) of RGB.
cv::Mat1f greyOf(const cv::Mat3f& picture);

inline constexpr double kHighPassSigmaPixels = 6.0;
/// Removes structure coarser than marks: a − Gaussian(6 px) ∗ a.
cv::Mat3f highPass(const cv::Mat3f& picture);

/// The part of a frame within its border.
cv::Rect innerRect(cv::Size frame);

/// Adds sensor noise to an image: white Gaussian noise of `sigmaLevels` (8-bit levels) on each
/// channel, rounded to RGB8. The noise depends on `seed` only.
hal::Image withSensorNoise(const cv::Mat3f& picture, double sigmaLevels, std::uint64_t seed);

}  // namespace pleinair::measure
