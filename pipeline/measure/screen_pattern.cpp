#include "pipeline/measure/screen_pattern.h"

#include <cmath>

#include <opencv2/imgproc.hpp>

namespace pleinair::measure {

cv::Mat1f relativeGradient(const cv::Mat1f& grey) {
  constexpr double kSigmaPixels = 8.0;
  constexpr double kFloor = 1.0 / 255.0;
  cv::Mat1f alongX;
  cv::Mat1f alongY;
  cv::Sobel(grey, alongX, CV_32F, 1, 0);
  cv::Sobel(grey, alongY, CV_32F, 0, 1);
  cv::Mat1f strength;
  cv::magnitude(alongX, alongY, strength);
  cv::Mat1f mean;
  cv::GaussianBlur(strength, mean, {}, kSigmaPixels);
  mean += kFloor;
  cv::Mat1f relative;
  cv::divide(strength, mean, relative);
  return relative;
}

std::optional<double> screenCorrelation(const cv::Mat1f& earlier, const cv::Mat1f& later,
                                        const cv::Mat1b& mask) {
  cv::Scalar meanA, meanB, deviationA, deviationB;
  cv::meanStdDev(earlier, meanA, deviationA, mask);
  cv::meanStdDev(later, meanB, deviationB, mask);
  double products = 0;
  double count = 0;
  for (int y = 0; y < mask.rows; ++y) {
    for (int x = 0; x < mask.cols; ++x) {
      if (mask(y, x) == 0) continue;
      products += (static_cast<double>(earlier(y, x)) - meanA[0]) *
                  (static_cast<double>(later(y, x)) - meanB[0]);
      count += 1;
    }
  }
  const double scale = deviationA[0] * deviationB[0] * count;
  if (!(scale > 0)) return std::nullopt;
  return products / scale;
}

}  // namespace pleinair::measure
