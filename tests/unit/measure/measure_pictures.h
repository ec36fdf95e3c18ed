#pragma once

#include <cstdint>

#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

namespace pleinair::measure {

/// White Gaussian noise around middle grey, independent per channel.
inline cv::Mat3f noisePicture(cv::Size size, double sigma, std::uint64_t seed) {
  cv::RNG random(seed);
  cv::Mat3f picture(size);
  random.fill(picture, cv::RNG::NORMAL, 0.5, sigma);
  return picture;
}

/// Blobs of a few px, which give corners.
inline cv::Mat3f blobPicture(cv::Size size, std::uint64_t seed) {
  cv::Mat3f picture;
  cv::GaussianBlur(noisePicture(size, 1.0, seed), picture, {}, 2.0);
  return picture;
}

/// The part of `canvas` of this `size` at a position: the view of a camera that pans over it.
inline cv::Mat3f windowOf(const cv::Mat3f& canvas, cv::Point at, cv::Size size) {
  return canvas(cv::Rect(at, size)).clone();
}

/// gain · picture + offset.
inline cv::Mat3f toned(const cv::Mat3f& picture, double gain, double offset = 0) {
  cv::Mat3f result = picture.clone();
  for (cv::Vec3f& pixel : result) {
    for (float& value : pixel.val) value = static_cast<float>(gain * value + offset);
  }
  return result;
}

/// Blobs with the contrast of a photograph.
inline cv::Mat3f strongBlobs(cv::Size size, std::uint64_t seed) {
  return toned(blobPicture(size, seed), 1.5, -0.25);
}

inline cv::Mat1f greyNoise(cv::Size size, double sigma, std::uint64_t seed) {
  cv::Mat1f grey;
  cv::extractChannel(noisePicture(size, sigma, seed), grey, 0);
  return grey;
}

}  // namespace pleinair::measure
