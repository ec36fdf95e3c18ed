#pragma once

#include <cmath>

#include <glm/vec3.hpp>

namespace pleinair::scene {

/// Relative luminance of linear light (BT.709 primaries, as sRGB has).
inline float luminanceOf(const glm::vec3& linearRgb) {
  return 0.2126F * linearRgb.r + 0.7152F * linearRgb.g + 0.0722F * linearRgb.b;
}

/// Decodes sRGB (IEC 61966-2-1).
inline float linearFromSrgb(float coded) {
  return coded <= 0.04045F ? coded / 12.92F : std::pow((coded + 0.055F) / 1.055F, 2.4F);
}
inline glm::vec3 linearFromSrgb(const glm::vec3& srgb) {
  return {linearFromSrgb(srgb.r), linearFromSrgb(srgb.g), linearFromSrgb(srgb.b)};
}

}  // namespace pleinair::scene
