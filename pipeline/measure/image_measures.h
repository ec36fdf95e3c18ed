#pragma once

#include <optional>

#include <opencv2/core.hpp>

#include "pipeline/measure/input/motion_map.h"
#include "pipeline/measure/mean.h"

namespace pleinair::measure {

// Measures of images: one image beside another, which is later or the input.

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

/// Persistence of marks, measured in the images alone: the share of an image's corners (Shi and
/// Tomasi, 1994: 300 at most, quality 0.01, 8 px apart) that are found again in a later one, at x +
/// motion(x) ± 1 px, as a patch of 13×13 px whose normalised cross-correlation is above 0.8.
/// Corners that are partly or wholly outside of the later image do not count. Both images are grey.
Mean lastingMarks(const cv::Mat1f& earlier, const Warped<cv::Mat1f>& later);

/// Mean square of O − J within the border, where J is I with the best gain and offset per channel
/// (least squares): the distance of a painting from the photograph, apart from a tone curve. DEP is
/// 255 times its root.
Mean deviation(const cv::Mat3f& output, const cv::Mat3f& input);

/// The input with the gain and the offset of each channel that make it most like the painting where
/// `without` is 0; with an offset alone where the input varies by less than 8 levels there.
cv::Mat3b inPaletteOf(const cv::Mat3b& painting, const cv::Mat3b& input, const cv::Mat1b& without);

/// Mean square within the border; of a high pass it is the amount of detail.
Mean meanSquare(const cv::Mat3f& picture);

/// Sum of absolute differences of two frames within the border, over all channels: flicker if
/// nothing moves.
Mean absoluteDifference(const cv::Mat3f& a, const cv::Mat3f& b);

/// Strength of the gradient relative to its surroundings: |∇a| (Sobel) over its own mean (Gaussian,
/// σ = 8 px, plus 1/255), so that a pattern counts equally in strong and weak images.
cv::Mat1f relativeGradient(const cv::Mat1f& grey);

/// Measures the shower-door effect: the normalised cross-correlation in [−1, 1] of two relative
/// gradients at the same screen positions within the mask, for frames between which the image
/// moved. Nothing where one of them is constant or the mask is empty.
std::optional<double> screenCorrelation(const cv::Mat1f& earlier, const cv::Mat1f& later,
                                        const cv::Mat1b& mask);

}  // namespace pleinair::measure
