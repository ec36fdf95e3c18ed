#pragma once

#include <optional>

#include <opencv2/core.hpp>

namespace pleinair::measure {

/// Strength of the gradient relative to its surroundings: |∇a| (Sobel) over its own mean (Gaussian,
/// σ = 8 px, plus 1/255), so that a pattern counts equally in strong and weak images.
cv::Mat1f relativeGradient(const cv::Mat1f& grey);

/// Measures the shower-door effect: the normalised cross-correlation in [−1, 1] of two relative
/// gradients at the same screen positions within the mask, for frames between which the image
/// moved. Nothing where one of them is constant or the mask is empty.
std::optional<double> screenCorrelation(const cv::Mat1f& earlier, const cv::Mat1f& later,
                                        const cv::Mat1b& mask);

}  // namespace pleinair::measure
