#include "hal/cameras/aravis/unpack12.h"

#include <array>
#include <cstdint>
#include <random>
#include <vector>

#include <gtest/gtest.h>

namespace pleinair::hal::aravis {
namespace {

/// PFNC "p" packing, bit by bit: sample i has bits 12 i … 12 i + 11, the least significant first.
std::vector<std::uint8_t> packed12p(const std::vector<std::uint16_t>& samples) {
  std::vector<std::uint8_t> bytes((samples.size() * 12 + 7) / 8);
  for (std::size_t bit = 0; bit < samples.size() * 12; ++bit) {
    const int value = samples[bit / 12] >> (bit % 12) & 1;
    bytes[bit / 8] = static_cast<std::uint8_t>(bytes[bit / 8] | value << (bit % 8));
  }
  return bytes;
}

/// GigE Vision 1.2, figure "Mono12Packed".
std::vector<std::uint8_t> packed12Packed(const std::vector<std::uint16_t>& samples) {
  std::vector<std::uint8_t> bytes;
  for (std::size_t i = 0; i < samples.size(); i += 2) {
    const int a = samples[i];
    const int b = i + 1 < samples.size() ? samples[i + 1] : 0;
    bytes.push_back(static_cast<std::uint8_t>(a >> 4));
    bytes.push_back(static_cast<std::uint8_t>((b & 0xF) << 4 | (a & 0xF)));
    if (i + 1 < samples.size()) bytes.push_back(static_cast<std::uint8_t>(b >> 4));
  }
  return bytes;
}

std::vector<std::uint16_t> everySample() {
  std::vector<std::uint16_t> samples(4096 * 2 + 1);
  std::mt19937 random(1);
  for (std::size_t i = 0; i < samples.size(); ++i) {
    samples[i] = static_cast<std::uint16_t>(i < 4096 ? i : random() % 4096);
  }
  return samples;
}

TEST(Unpack12, KeepsTheUpperEightBitsOfEverySample) {
  const std::vector<std::uint16_t> samples = everySample();
  for (std::size_t count :
       {std::size_t{0}, std::size_t{1}, std::size_t{2}, std::size_t{7}, samples.size()}) {
    const std::vector<std::uint16_t> part(samples.end() - static_cast<std::ptrdiff_t>(count),
                                          samples.end());
    std::vector<std::uint8_t> p(count), split(count);
    unpack12p(packed12p(part), p);
    unpack12Packed(packed12Packed(part), split);
    for (std::size_t i = 0; i < count; ++i) {
      ASSERT_EQ(p[i], part[i] >> 4) << "12p, sample " << i << " of " << count;
      ASSERT_EQ(split[i], part[i] >> 4) << "12Packed, sample " << i << " of " << count;
    }
  }
}

TEST(Unpack12, HasTheByteOrderOfTheConventions) {
  // a = 0xABC, b = 0x123
  std::array<std::uint8_t, 2> samples{};
  unpack12p(std::array<std::uint8_t, 3>{0xBC, 0x3A, 0x12}, samples);
  EXPECT_EQ(samples, (std::array<std::uint8_t, 2>{0xAB, 0x12}));
  unpack12Packed(std::array<std::uint8_t, 3>{0xAB, 0x3C, 0x12}, samples);
  EXPECT_EQ(samples, (std::array<std::uint8_t, 2>{0xAB, 0x12}));
}

}  // namespace
}  // namespace pleinair::hal::aravis
