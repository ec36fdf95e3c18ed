#pragma once

#include <opencv2/core.hpp>

#include "hal/image.h"

namespace pleinair::measure {

/// What is within this many px of the border is not looked at (docs/measuring.md).
inline constexpr int kBorderPixels = 40;
/// Frames below this, of either side, are not measured: too little would be left of them.
inline constexpr int kLeastSidePixels = 160;

/// RGB in [0, 1]. Precondition: the picture is RGB8.
cv::Mat3f toFloat(const hal::ImageView& rgb8);
/// RGB8 again, rounded and clamped.
hal::Image toImage(const cv::Mat3f& picture);

/// Luma (BT.601) of RGB.
cv::Mat1f greyOf(const cv::Mat3f& picture);

/// The picture without what is coarser than marks: a − Gaussian(6 px) ∗ a.
cv::Mat3f highPass(const cv::Mat3f& picture);

/// What is left of a frame without its border.
cv::Rect innerRect(cv::Size frame);

}  // namespace pleinair::measure
