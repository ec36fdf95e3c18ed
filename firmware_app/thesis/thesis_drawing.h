#pragma once

#include <string>
#include <utility>
#include <vector>

#include <opencv2/core.hpp>

namespace pleinair::app {

// Sheets of pictures (RGB) for a report.

/// Beside each other, or below each other, with a white gap. Precondition: equal heights (widths).
cv::Mat3b inRow(const std::vector<cv::Mat3b>& pictures);
cv::Mat3b inColumn(const std::vector<cv::Mat3b>& pictures);
/// A part, enlarged without smoothing between whole pixels.
cv::Mat3b enlarged(const cv::Mat3b& picture, const cv::Rect& part, int factor);
/// Paler, so that lines and dots stand out.
cv::Mat3b pale(const cv::Mat3b& picture);
void addDot(cv::Mat3b& picture, cv::Point2d px, const cv::Scalar& colour);
/// A rectangle of `size` within the picture, as near to being centred on the middle of the mask's
/// pixels as can be; the picture's middle where it has none.
cv::Rect partAround(const cv::Mat1b& mask, cv::Size size);
/// A bar for each value from 0 up, with its text and its value.
cv::Mat3b bars(const std::vector<std::pair<std::string, double>>& values, const std::string& unit);
/// Grows small pictures to about this width by a whole factor.
cv::Mat3b atLeast(const cv::Mat3b& picture, int width);

}  // namespace pleinair::app
