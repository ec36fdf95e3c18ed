#include "hal/cameras/synthetic/render/sensor.h"

#include <array>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "hal/cameras/synthetic/render/sampler.h"
#include "hal/cameras/synthetic/world/srgb.h"

namespace pleinair::hal::synthetic {
namespace {

constexpr std::size_t kPixels = 6000;
constexpr SensorGains kNoGains{1, 1, 1};

std::vector<std::uint8_t> exposed(Sensor sensor, std::uint64_t frame, int y, int level = 128) {
  const std::vector<std::int16_t> grey(3 * kPixels, static_cast<std::int16_t>(level << kLevelBits));
  std::vector<std::uint8_t> rgb8(3 * kPixels);
  sensor.beginFrame(frame, kNoGains);
  sensor.exposeRow(y, grey, rgb8);
  return rgb8;
}

/// The correlation of two samples around level 128, the second read at an offset of `shift`.
double correlation(const std::vector<std::uint8_t>& a, const std::vector<std::uint8_t>& b,
                   std::size_t shift = 0) {
  double product = 0;
  double squares = 0;
  for (std::size_t i = 0; i + shift < a.size(); ++i) {
    product += (a[i] - 128.0) * (b[i + shift] - 128.0);
    squares += (a[i] - 128.0) * (a[i] - 128.0);
  }
  return product / squares;
}

TEST(Sensor, KeepsLevelsWithoutNoise) {
  for (const int level : {0, 1, 17, 100, 200, 254, 255}) {
    for (const std::uint8_t byte : exposed(Sensor(1, 0), 0, 0, level)) ASSERT_EQ(byte, level);
  }
}

TEST(Sensor, RoundsSixtyFourths) {
  Sensor sensor(1, 0);
  const std::array<std::int16_t, 3> levels{6431, 6432, 6463};
  std::array<std::uint8_t, 3> rgb8{};
  sensor.beginFrame(0, kNoGains);
  sensor.exposeRow(0, levels, rgb8);
  EXPECT_EQ(rgb8, (std::array<std::uint8_t, 3>{100, 101, 101}));
}

TEST(Sensor, NoiseHasTheSigmaAskedFor) {
  for (const double sigma : {1.0, 2.0, 5.0, 20.0}) {
    double sum = 0;
    double squares = 0;
    double count = 0;
    for (int row = 0; row < 12; ++row) {
      for (const std::uint8_t level : exposed(Sensor(7, sigma), 3, row)) {
        sum += level - 128.0;
        squares += (level - 128.0) * (level - 128.0);
        ++count;
      }
    }
    const double mean = sum / count;
    const double variance = squares / count - mean * mean;
    EXPECT_NEAR(mean, 0, 0.02 * sigma + 0.02);
    EXPECT_NEAR(std::sqrt(variance), std::sqrt(sigma * sigma + 1 / 12.0), 0.025 * sigma)
        << "rounding adds 1/12";
  }
}

TEST(Sensor, NoiseIsNormal) {
  // A sum of two from a normal table: 68.3 % within σ, 95.4 % within 2 σ.
  const double sigma = 20;
  int within1 = 0;
  int within2 = 0;
  for (const std::uint8_t level : exposed(Sensor(7, sigma), 3, 5)) {
    within1 += std::abs(level - 128) <= 20 ? 1 : 0;
    within2 += std::abs(level - 128) <= 40 ? 1 : 0;
  }
  EXPECT_NEAR(within1 / (3.0 * kPixels), 0.694, 0.015) << "of whole levels up to 20.5";
  EXPECT_NEAR(within2 / (3.0 * kPixels), 0.957, 0.01);
}

TEST(Sensor, NoiseIsNewInEachFrameRowChannelAndSeed) {
  const Sensor sensor(7, 5);
  const std::vector<std::uint8_t> rgb8 = exposed(sensor, 3, 5);
  EXPECT_EQ(rgb8, exposed(sensor, 3, 5));
  EXPECT_LT(std::abs(correlation(rgb8, exposed(sensor, 4, 5))), 0.04);
  EXPECT_LT(std::abs(correlation(rgb8, exposed(sensor, 3, 6))), 0.04);
  EXPECT_LT(std::abs(correlation(rgb8, exposed(Sensor(8, 5), 3, 5))), 0.04);
  for (const std::size_t shift : {1U, 2U, 3U, 48U}) {
    EXPECT_LT(std::abs(correlation(rgb8, rgb8, shift)), 0.04) << shift;
  }
}

TEST(Sensor, MultipliesLightNotLevels) {
  Sensor sensor(1, 0);
  const auto half = static_cast<std::int16_t>(std::lround(64 * levelFromLinear(0.2F)));
  const std::array<std::int16_t, 3> levels{half, half, half};
  std::array<std::uint8_t, 3> rgb8{};
  sensor.beginFrame(0, {2, 1, 0.5});
  sensor.exposeRow(0, levels, rgb8);
  EXPECT_NEAR(rgb8[0], levelFromLinear(0.4F), 0.7F);
  EXPECT_NEAR(rgb8[1], levelFromLinear(0.2F), 0.7F);
  EXPECT_NEAR(rgb8[2], levelFromLinear(0.1F), 0.7F);
  sensor.beginFrame(1, kNoGains);
  sensor.exposeRow(0, levels, rgb8);
  EXPECT_NEAR(rgb8[0], levelFromLinear(0.2F), 0.5F) << "a frame without gains after one with";
}

}  // namespace
}  // namespace pleinair::hal::synthetic
