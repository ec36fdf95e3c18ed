#include "hal/cameras/synthetic/sensor.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstddef>

#include "hal/cameras/synthetic/noise.h"

namespace pleinair::hal::synthetic {
namespace {

constexpr std::size_t kLightSteps = 8192;
constexpr std::size_t kNoiseSteps = 4096;
constexpr std::uint64_t kNoiseMask = kNoiseSteps - 1;

/// IEC 61966-2-1.
double srgbFromLinear(double linear) {
  return linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1 / 2.4) - 0.055;
}

/// The standard normal's value with this much probability below it, by bisection.
double normalQuantile(double probability) {
  double low = -6;
  double high = 6;
  for (int step = 0; step < 50; ++step) {
    const double middle = (low + high) / 2;
    const double below = 0.5 * std::erfc(-middle * std::sqrt(0.5));
    (below < probability ? low : high) = middle;
  }
  return (low + high) / 2;
}

}  // namespace

Sensor::Sensor(std::uint64_t seed, double noiseSigma)
    : seed_(mixBits(seed ^ 0x5e4507ULL)), levels_(kLightSteps + 1), noise_(kNoiseSteps) {
  for (std::size_t i = 0; i <= kLightSteps; ++i) {
    const double linear = std::min(1.0, (static_cast<double>(i) + 0.5) / kLightSteps);
    levels_[i] = static_cast<float>(255 * srgbFromLinear(linear));
  }
  for (std::size_t i = 0; i < kNoiseSteps; ++i) {
    const double probability = (static_cast<double>(i) + 0.5) / kNoiseSteps;
    noise_[i] = static_cast<float>(noiseSigma * normalQuantile(probability) + 0.5);
  }
}

void Sensor::exposeRun(std::uint64_t frame, int x, int y, std::span<const glm::vec3> linearRgb,
                       std::span<std::uint8_t> rgb8) const {
  assert(rgb8.size() == 3 * linearRgb.size());
  const std::uint64_t row = mixBits(mixBits(seed_ ^ frame) + static_cast<std::uint64_t>(y));
  const std::uint64_t first = row + static_cast<std::uint64_t>(x);
  std::uint8_t* out = rgb8.data();
  for (std::size_t i = 0; i < linearRgb.size(); ++i) {
    std::uint64_t bits = mixBits(first + i);
    for (int channel = 0; channel < 3; ++channel, bits >>= 20) {
      const float light = std::clamp(linearRgb[i][channel], 0.0F, 1.0F);
      const auto step = static_cast<std::size_t>(light * kLightSteps);
      const float level = levels_[step] + noise_[bits & kNoiseMask];
      *out++ = static_cast<std::uint8_t>(std::clamp(level, 0.0F, 255.0F));
    }
  }
}

}  // namespace pleinair::hal::synthetic
