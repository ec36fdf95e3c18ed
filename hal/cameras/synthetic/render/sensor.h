#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace pleinair::hal::synthetic {

/// What a frame's light is multiplied by, channel by channel.
using SensorGains = std::array<double, 3>;

/// Turns levels in sixty-fourths into bytes: gains (in linear light), Gaussian noise, rounding. The
/// noise of a pixel is a pure function of (seed, frame, row, column, channel): two stretches of a
/// table, begun anywhere, added up.
class Sensor {
 public:
  /// `noiseSigma` in 8-bit levels of the coded picture; at most kMostNoise.
  static constexpr double kMostNoise = 40;
  Sensor(std::uint64_t seed, double noiseSigma);

  /// The frame whose rows follow.
  void beginFrame(std::uint64_t frame, const SensorGains& gains);
  /// Row `y`, three bytes a pixel. Precondition: the sizes are the same.
  void exposeRow(int y, std::span<const std::int16_t> levels, std::span<std::uint8_t> rgb8) const;

 private:
  void exposeGained(std::span<const std::int16_t> levels, const std::int16_t* first,
                    const std::int16_t* second, std::span<std::uint8_t> rgb8) const;

  std::uint64_t seed_;
  std::uint64_t frame_ = 0;
  bool isNoisy_;
  std::vector<std::int16_t> noise_;  ///< sixty-fourths, at random
  bool hasGains_ = false;
  SensorGains gains_{1, 1, 1};
  std::array<std::vector<std::int16_t>, 3> gained_;  ///< levels by quarters of a level
};

}  // namespace pleinair::hal::synthetic
