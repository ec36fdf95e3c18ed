#pragma once

#include <array>

namespace pleinair::measure {

/// Of the four samples around a point that is `t` past the second: cubic convolution (Keys, 1981)
/// with a = −0.5, which passes quadratics exactly.
inline std::array<float, 4> cubicWeights(float t) {
  return {((-0.5F * t + 1.0F) * t - 0.5F) * t, (1.5F * t - 2.5F) * t * t + 1.0F,
          ((-1.5F * t + 2.0F) * t + 0.5F) * t, (0.5F * t - 0.5F) * t * t};
}

}  // namespace pleinair::measure
