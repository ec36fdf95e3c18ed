#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace pleinair::hal::synthetic {

/// Gains of a frame's linear light, one per channel.
using SensorGains = std::array<double, 3>;

/// Converts levels in sixty-fourths to bytes: gains (in linear light), Gaussian noise, rounding. A
/// pixel's noise is a pure function of (seed, frame, row, column, channel): the sum of two runs of
/// a table, each from its own offset.
class Sensor {
 public:
  /// `noiseSigma` in 8-bit levels of the coded picture; at most kMaxNoise.
  static constexpr double kMaxNoise = 40;
  Sensor(std::uint64_t seed, double noiseSigma);

  /// Selects the frame that the next rows belong to.
  void beginFrame(std::uint64_t frame, const SensorGains& gains);
  /// Converts row `y`, three bytes per pixel. Precondition: the sizes are the same.
  void exposeRow(int y, std::span<const std::int16_t> levels, std::span<std::uint8_t> rgb8) const;

 private:
  void exposeGained(std::span<const std::int16_t> levels, const std::int16_t* first,
                    const std::int16_t* second, std::span<std::uint8_t> rgb8) const;

  std::uint64_t seed_;
  std::uint64_t frame_ = 0;
  bool isNoisy_;
  std::vector<std::int16_t> noise_;  ///< in sixty-fourths, shuffled
  bool hasGains_ = false;
  SensorGains gains_{1, 1, 1};
  /// output levels, indexed by quarters of a level
  std::array<std::vector<std::int16_t>, 3> gained_;
};

}  // namespace pleinair::hal::synthetic
