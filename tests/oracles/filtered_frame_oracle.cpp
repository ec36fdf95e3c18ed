#include "tests/oracles/filtered_frame_oracle.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include <glm/common.hpp>
#include <glm/exponential.hpp>
#include <glm/vec3.hpp>

#include "tests/oracles/watercolor_oracle.h"

namespace pleinair::oracles {
namespace {

/// Catmull and Rom's cubic through four values, between the middle two.
double catmullRom(double f, int tap) {
  const double x = std::abs(f - (tap - 1));
  return x < 1.0   ? 1.5 * x * x * x - 2.5 * x * x + 1.0
         : x < 2.0 ? -0.5 * x * x * x + 2.5 * x * x - 4.0 * x + 2.0
                   : 0.0;
}

double smoothstep(double low, double high, double x) {
  const double t = std::clamp((x - low) / (high - low), 0.0, 1.0);
  return t * t * (3.0 - 2.0 * t);
}

}  // namespace

void FilteredFrameOracle::take(const hal::ImageView& frame, const Flow& flow, double kept,
                               double noise) {
  const hal::FrameSize now = frame.format.size;
  const std::vector<glm::dvec4> past = picture;
  const bool hasPast = kept > 0.0 && !past.empty() && size == now;
  size = now;
  picture.assign(static_cast<std::size_t>(now.pixels()), glm::dvec4(0.0));
  const auto index = [&](int x, int y) {
    return static_cast<std::size_t>(std::clamp(y, 0, now.height - 1)) *
               static_cast<std::size_t>(now.width) +
           static_cast<std::size_t>(std::clamp(x, 0, now.width - 1));
  };
  for (int y = 0; y < now.height; ++y) {
    for (int x = 0; x < now.width; ++x) {
      const glm::dvec3 colour = pixelAt(frame, x, y);
      glm::dvec4& result = picture[index(x, y)];
      result = glm::dvec4(colour, 1.0);
      const glm::dvec3 moved = flow({x / 4, y / 4});
      const glm::dvec2 from(x + 0.5 - moved.x, y + 0.5 - moved.y);
      const bool isInside =
          from.x > 0.0 && from.y > 0.0 && from.x < now.width && from.y < now.height;
      if (!hasPast || moved.z < 0.0 || !isInside) continue;

      glm::dvec4 then(0.0);
      const glm::dvec2 base = glm::floor(from - 0.5);
      for (int j = 0; j < 4; ++j) {
        for (int i = 0; i < 4; ++i) {
          then += catmullRom(from.x - 0.5 - base.x, i) * catmullRom(from.y - 0.5 - base.y, j) *
                  past[index(static_cast<int>(base.x) + i - 1, static_cast<int>(base.y) + j - 1)];
        }
      }
      glm::dvec3 mean(0.0);
      glm::dvec3 square(0.0);
      for (int j = -1; j <= 1; ++j) {
        for (int i = -1; i <= 1; ++i) {
          const glm::dvec3 near = pixelAt(frame, x + i, y + j);
          mean += near / 9.0;
          square += near * near / 9.0;
        }
      }
      const glm::dvec3 reach =
          1.5 * glm::sqrt(glm::max(square - mean * mean, 0.0)) + glm::dvec3(2.0 * noise);
      const double trust = 1.0 - smoothstep(0.75, 2.0, moved.z);
      const double frames = kept * std::min(64.0, trust * std::max(0.0, then.a));
      const glm::dvec3 bounded = glm::clamp(glm::dvec3(then), mean - reach, mean + reach);
      result = glm::dvec4((colour + frames * bounded) / (1.0 + frames), 1.0 + frames);
    }
  }
}

}  // namespace pleinair::oracles
