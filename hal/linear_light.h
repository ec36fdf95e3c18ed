#pragma once

#include <cmath>
#include <concepts>

#include "hal/pixel_format.h"

namespace pleinair::hal {

/// The shares of red, green and blue in the luma of a coded colour, or in the luminance of a linear
/// one. Their sum is 1.
struct LumaWeights {
  double red;
  double green;
  double blue;
};

/// The weights of a colour matrix. BT.709's are also those of the luminance of linear sRGB.
constexpr LumaWeights lumaWeights(ColorMatrix matrix) {
  return matrix == ColorMatrix::kBt709 ? LumaWeights{.red = 0.2126, .green = 0.7152, .blue = 0.0722}
                                       : LumaWeights{.red = 0.299, .green = 0.587, .blue = 0.114};
}

/// Decodes a channel of sRGB (IEC 61966-2-1), in [0, 1].
template <std::floating_point T>
T linearFromSrgb(T coded) {
  return coded <= T(0.04045) ? coded / T(12.92) : std::pow((coded + T(0.055)) / T(1.055), T(2.4));
}

/// Codes a channel of linear light as sRGB, in [0, 1].
template <std::floating_point T>
T srgbFromLinear(T linear) {
  return linear <= T(0.0031308) ? T(12.92) * linear
                                : T(1.055) * std::pow(linear, T(1) / T(2.4)) - T(0.055);
}

}  // namespace pleinair::hal
