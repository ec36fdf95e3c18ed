#include "pipeline/measure/input/picture.h"

#include <cassert>

#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

namespace pleinair::measure {
namespace {

/// A cv::Mat header over the pixels of an image, which OpenCV only reads.
cv::Mat borrowed(const hal::ImageView& image) {
  const bool isRgb = image.format.pixelFormat == hal::PixelFormat::kRgb8;
  assert((isRgb || image.format.pixelFormat == hal::PixelFormat::kGrey8) && image.isComplete());
  const hal::PlaneView& plane = image.planes[0];
  auto* const bytes = const_cast<std::uint8_t*>(plane.bytes.data());
  return {image.format.size.height, image.format.size.width, isRgb ? CV_8UC3 : CV_8UC1, bytes,
          plane.strideBytes};
}

}  // namespace

cv::Mat3f toFloat(const hal::ImageView& rgb8) {
  assert(rgb8.format.pixelFormat == hal::PixelFormat::kRgb8);
  cv::Mat3f picture;
  borrowed(rgb8).convertTo(picture, CV_32F, 1.0 / 255.0);
  return picture;
}

cv::Mat toLevels(const hal::ImageView& image) {
  return borrowed(image).clone();
}

hal::Image toImage(const cv::Mat3f& picture) {
  hal::Image image({.pixelFormat = hal::PixelFormat::kRgb8,
                    .size = {picture.cols, picture.rows},
                    .encoding = {}});
  cv::Mat levels(picture.rows, picture.cols, CV_8UC3, image.plane(0).data());
  picture.convertTo(levels, CV_8U, 255.0);
  assert(levels.data == image.plane(0).data());
  return image;
}

cv::Mat1f greyOf(const cv::Mat3f& picture) {
  cv::Mat1f grey;
  cv::cvtColor(picture, grey, cv::COLOR_RGB2GRAY);
  return grey;
}

cv::Mat3f highPass(const cv::Mat3f& picture) {
  cv::Mat3f coarse;
  cv::GaussianBlur(picture, coarse, {}, kHighPassSigmaPixels);
  cv::Mat3f fine;
  cv::subtract(picture, coarse, fine);
  return fine;
}

cv::Rect innerRect(cv::Size frame) {
  return {kBorderPixels, kBorderPixels, frame.width - 2 * kBorderPixels,
          frame.height - 2 * kBorderPixels};
}

hal::Image withSensorNoise(const cv::Mat3f& picture, double sigmaLevels, std::uint64_t seed) {
  if (sigmaLevels <= 0) return toImage(picture);
  // Spreads seeds: sequences of neighbouring seeds would begin alike.
  constexpr std::uint64_t kSpread = 0x9E3779B97F4A7C15U;
  cv::RNG random((seed + 1) * kSpread);
  cv::Mat3f noisy(picture.size());
  random.fill(noisy, cv::RNG::NORMAL, 0.0, sigmaLevels / 255.0);
  noisy += picture;
  return toImage(noisy);
}

}  // namespace pleinair::measure
