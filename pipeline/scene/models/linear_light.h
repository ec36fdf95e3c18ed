#pragma once

#include <glm/vec3.hpp>

#include "hal/linear_light.h"

namespace pleinair::scene {

/// Relative luminance of linear light (BT.709 primaries, as sRGB has).
inline float luminanceOf(const glm::vec3& linearRgb) {
  constexpr hal::LumaWeights kWeights = hal::lumaWeights(hal::ColorMatrix::kBt709);
  return static_cast<float>(kWeights.red) * linearRgb.r +
         static_cast<float>(kWeights.green) * linearRgb.g +
         static_cast<float>(kWeights.blue) * linearRgb.b;
}

/// Decodes sRGB.
using hal::linearFromSrgb;
inline glm::vec3 linearFromSrgb(const glm::vec3& srgb) {
  return {linearFromSrgb(srgb.r), linearFromSrgb(srgb.g), linearFromSrgb(srgb.b)};
}

}  // namespace pleinair::scene
