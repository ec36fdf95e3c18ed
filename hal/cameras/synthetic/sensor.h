#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <glm/vec3.hpp>

namespace pleinair::hal::synthetic {

/// Turns light into bytes: sRGB coding, Gaussian noise, rounding. The noise of a pixel is a pure
/// function of (seed, frame, row, column, channel). Immutable; thread-safe.
class Sensor {
 public:
  /// `noiseSigma` in 8-bit levels of the coded picture.
  Sensor(std::uint64_t seed, double noiseSigma);

  /// Pixels of row `y` from column `x` on, three bytes each. Precondition: the sizes fit.
  void exposeRun(std::uint64_t frame, int x, int y, std::span<const glm::vec3> linearRgb,
                 std::span<std::uint8_t> rgb8) const;

 private:
  std::uint64_t seed_;
  std::vector<float> levels_;  ///< coded level, 0 to 255, of even steps of linear light
  std::vector<float> noise_;   ///< equally likely noise, plus the half that rounds when cut off
};

}  // namespace pleinair::hal::synthetic
