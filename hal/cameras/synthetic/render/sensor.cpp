#include "hal/cameras/synthetic/render/sensor.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <numeric>

#include "hal/cameras/synthetic/render/sampler.h"
#include "hal/cameras/synthetic/world/noise.h"
#include "hal/cameras/synthetic/world/srgb.h"
#include "hal/linear_light.h"

namespace pleinair::hal::synthetic {
namespace {

using Byte16 = std::uint8_t __attribute__((vector_size(16)));
using Short8 = std::int16_t __attribute__((vector_size(16)));

constexpr std::size_t kNoiseSteps = std::size_t{1} << 15;
constexpr std::size_t kQuarters = (kLevelSteps >> 4) + 1;
constexpr std::int16_t kHalf = 1 << (kLevelBits - 1);

/// The quantile function of the standard normal distribution, by bisection.
double normalQuantile(double probability) {
  double low = -6;
  double high = 6;
  for (int step = 0; step < 40; ++step) {
    const double middle = (low + high) / 2;
    const double below = 0.5 * std::erfc(-middle * std::sqrt(0.5));
    (below < probability ? low : high) = middle;
  }
  return (low + high) / 2;
}

/// Equally likely values of a normal distribution, in random order.
std::vector<std::int16_t> noiseTable(std::uint64_t seed, double sigma) {
  constexpr std::size_t kValues = 1024;
  std::vector<std::int16_t> table(kNoiseSteps);
  for (std::size_t i = 0; i < kValues; ++i) {
    const double probability = (static_cast<double>(i) + 0.5) / kValues;
    // Each pixel adds two table values, hence √0.5. The factor 1.0005 makes up for the tails that
    // the table lacks.
    const double value = sigma * std::sqrt(0.5) * 1.0005 * normalQuantile(probability);
    const auto fixed = static_cast<std::int16_t>(std::lround(value * (1 << kLevelBits)));
    for (std::size_t copy = i; copy < kNoiseSteps; copy += kValues) table[copy] = fixed;
  }
  for (std::size_t i = kNoiseSteps - 1; i > 0; --i) {
    std::swap(table[i],
              table[static_cast<std::size_t>(unitRandom(seed, i) * static_cast<double>(i + 1))]);
  }
  return table;
}

Short8 load(const std::int16_t* from) {
  Short8 values;
  std::memcpy(&values, from, sizeof(values));
  return values;
}

/// Adds gain and noise to eight values and rounds them to bytes, in the low byte of each lane.
Short8 rounded(const std::int16_t* levels, const std::int16_t* first, const std::int16_t* second) {
  const Short8 sum = (load(levels) + load(first) + load(second) + kHalf) >> kLevelBits;
  const Short8 fromZero = sum > 0 ? sum : Short8{};
  const Short8 most = Short8{} + 255;
  return fromZero < most ? fromZero : most;
}

void expose(const std::int16_t* levels, const std::int16_t* first, const std::int16_t* second,
            std::size_t count, std::uint8_t* out) {
  std::size_t i = 0;
  for (; i + 16 <= count; i += 16) {
    const auto low = Byte16(rounded(levels + i, first + i, second + i));
    const auto high = Byte16(rounded(levels + i + 8, first + i + 8, second + i + 8));
    const Byte16 bytes = __builtin_shufflevector(low, high, 0, 2, 4, 6, 8, 10, 12, 14, 16, 18, 20,
                                                 22, 24, 26, 28, 30);
    std::memcpy(out + i, &bytes, sizeof(bytes));
  }
  for (; i < count; ++i) {
    const int sum = (levels[i] + first[i] + second[i] + kHalf) >> kLevelBits;
    out[i] = static_cast<std::uint8_t>(std::clamp(sum, 0, 255));
  }
}

}  // namespace

Sensor::Sensor(std::uint64_t seed, double noiseSigma)
    : seed_(mixBits(seed ^ 0x5e4507ULL)), isNoisy_(noiseSigma > 0) {
  if (isNoisy_) noise_ = noiseTable(seed_, std::min(noiseSigma, kMaxNoise));
}

void Sensor::beginFrame(std::uint64_t frame, const SensorGains& gains) {
  frame_ = frame;
  hasGains_ = gains != SensorGains{1, 1, 1};
  if (!hasGains_ || (gains == gains_ && !gained_[0].empty())) return;
  gains_ = gains;
  for (std::size_t channel = 0; channel < 3; ++channel) {
    std::vector<std::int16_t>& table = gained_[channel];
    table.resize(kQuarters);
    for (std::size_t i = 0; i < kQuarters; ++i) {
      const double coded = static_cast<double>(i) / (kQuarters - 1);
      const auto gained = static_cast<float>(hal::linearFromSrgb(coded) * gains[channel]);
      table[i] = static_cast<std::int16_t>(std::lround(levelFromLinear(gained) * 64));
    }
  }
}

void Sensor::exposeRow(int y, std::span<const std::int16_t> levels,
                       std::span<std::uint8_t> rgb8) const {
  assert(levels.size() == rgb8.size());
  static const std::vector<std::int16_t> kSilence(kNoiseSteps);
  const std::size_t count = levels.size();
  assert(count < kNoiseSteps);
  const std::uint64_t bits = mixBits(mixBits(seed_ ^ frame_) + static_cast<std::uint64_t>(y));
  const std::int16_t* table = isNoisy_ ? noise_.data() : kSilence.data();
  const std::int16_t* first = table + (bits & 0xFFFFFFFFU) % (kNoiseSteps - count);
  const std::int16_t* second = table + (bits >> 32) % (kNoiseSteps - count);
  if (hasGains_) {
    exposeGained(levels, first, second, rgb8);
  } else {
    expose(levels.data(), first, second, count, rgb8.data());
  }
}

void Sensor::exposeGained(std::span<const std::int16_t> levels, const std::int16_t* first,
                          const std::int16_t* second, std::span<std::uint8_t> rgb8) const {
  constexpr std::size_t kBlock = 384;
  std::array<std::int16_t, kBlock> block{};
  for (std::size_t begin = 0; begin < levels.size(); begin += kBlock) {
    const std::size_t count = std::min(kBlock, levels.size() - begin);
    for (std::size_t i = 0; i < count; ++i) {
      block[i] = gained_[i % 3][static_cast<std::size_t>(levels[begin + i]) >> 4];
    }
    expose(block.data(), first + begin, second + begin, count, rgb8.data() + begin);
  }
}

}  // namespace pleinair::hal::synthetic
