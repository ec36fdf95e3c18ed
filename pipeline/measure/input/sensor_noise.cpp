#include "pipeline/measure/input/sensor_noise.h"

#include <opencv2/core.hpp>

#include "pipeline/measure/input/picture.h"

namespace pleinair::measure {

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
