#pragma once

#include <optional>

#include <opencv2/core.hpp>

namespace pleinair::measure {

/// How strong the gradient is beside those around it: |∇a| (Sobel) over its own mean (Gaussian,
/// σ = 8 px, plus 1/255), so that a pattern counts the same on strong and on weak pictures.
cv::Mat1f relativeGradient(const cv::Mat1f& grey);

/// The shower door: how much two relative gradients, of frames between which the picture has moved,
/// have in common at the same places of the screen: normalised cross-correlation in [−1, 1] where
/// the mask says so. Nothing where one of them is flat or the mask is empty.
std::optional<double> screenCorrelation(const cv::Mat1f& earlier, const cv::Mat1f& later,
                                        const cv::Mat1b& mask);

}  // namespace pleinair::measure
