#include "hal/cameras/synthetic/sensor.h"

#include <array>
#include <cmath>
#include <numeric>
#include <vector>

#include <gtest/gtest.h>

#include "hal/cameras/synthetic/mip_texture.h"

namespace pleinair::hal::synthetic {
namespace {

constexpr std::size_t kPixels = 20000;

std::vector<std::uint8_t> exposed(const Sensor& sensor, std::uint64_t frame, int y) {
  const std::vector<glm::vec3> grey(kPixels, linearFromSrgb(0x808080));
  std::vector<std::uint8_t> rgb8(3 * kPixels);
  sensor.exposeRun(frame, 0, y, grey, rgb8);
  return rgb8;
}

/// The correlation of two samples around level 128.
double correlation(const std::vector<std::uint8_t>& a, const std::vector<std::uint8_t>& b) {
  double product = 0;
  double squares = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    product += (a[i] - 128.0) * (b[i] - 128.0);
    squares += (a[i] - 128.0) * (a[i] - 128.0);
  }
  return product / squares;
}

TEST(Sensor, CodesAsSrgbWithoutNoise) {
  const Sensor sensor(1, 0);
  for (const int level : {0, 1, 17, 100, 200, 254, 255}) {
    const auto rrggbb = static_cast<std::uint32_t>(level * 0x010101);
    const std::array<glm::vec3, 1> light{linearFromSrgb(rrggbb)};
    std::array<std::uint8_t, 3> rgb8{};
    sensor.exposeRun(0, 0, 0, light, rgb8);
    EXPECT_EQ(rgb8[0], level);
    EXPECT_EQ(rgb8[2], level);
  }
}

TEST(Sensor, NoiseHasTheSigmaAskedFor) {
  for (const double sigma : {1.0, 2.0, 5.0}) {
    const std::vector<std::uint8_t> rgb8 = exposed(Sensor(7, sigma), 3, 5);
    double sum = 0;
    double squares = 0;
    for (const std::uint8_t level : rgb8) {
      sum += level - 128.0;
      squares += (level - 128.0) * (level - 128.0);
    }
    const double mean = sum / static_cast<double>(rgb8.size());
    const double variance = squares / static_cast<double>(rgb8.size()) - mean * mean;
    EXPECT_NEAR(mean, 0, 0.02 * sigma + 0.02);
    EXPECT_NEAR(std::sqrt(variance), std::sqrt(sigma * sigma + 1 / 12.0), 0.02 * sigma)
        << "rounding adds 1/12";
  }
}

TEST(Sensor, NoiseIsNewInEachFrameRowChannelAndSeed) {
  const Sensor sensor(7, 5);
  const std::vector<std::uint8_t> rgb8 = exposed(sensor, 3, 5);
  EXPECT_EQ(rgb8, exposed(sensor, 3, 5));
  EXPECT_LT(std::abs(correlation(rgb8, exposed(sensor, 4, 5))), 0.02);
  EXPECT_LT(std::abs(correlation(rgb8, exposed(sensor, 3, 6))), 0.02);
  EXPECT_LT(std::abs(correlation(rgb8, exposed(Sensor(8, 5), 3, 5))), 0.02);
  std::vector<std::uint8_t> nextChannel(rgb8.begin() + 1, rgb8.end());
  nextChannel.push_back(rgb8.front());
  EXPECT_LT(std::abs(correlation(rgb8, nextChannel)), 0.02);
}

TEST(Sensor, NoiseBelongsToThePixelHoweverTheRowIsCut) {
  const Sensor sensor(1, 2);
  const std::vector<std::uint8_t> whole = exposed(sensor, 0, 9);
  const std::vector<glm::vec3> grey(100, linearFromSrgb(0x808080));
  std::vector<std::uint8_t> part(300);
  sensor.exposeRun(0, 1000, 9, grey, part);
  EXPECT_TRUE(std::equal(part.begin(), part.end(), whole.begin() + 3000));
}

}  // namespace
}  // namespace pleinair::hal::synthetic
