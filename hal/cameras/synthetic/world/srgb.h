#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

#include <glm/vec3.hpp>

namespace pleinair::hal::synthetic {

/// sRGB coding (IEC 61966-2-1), per channel; light is linear, 0 to 1. Thread-safe.

/// 0xRRGGBB in linear light.
glm::vec3 linearFromSrgb(std::uint32_t rrggbb);
/// The level, 0 to 255, of light, which is clamped to 0 … 1.
float levelFromLinear(float linear);

struct SrgbTables {
  static constexpr std::size_t kSteps = 8192;
  std::array<float, 256> linear{};
  std::array<std::uint8_t, kSteps + 1> level{};
  SrgbTables();
};
inline const SrgbTables kSrgbTables;

inline float linearFromLevel(std::uint8_t level) {
  return kSrgbTables.linear[level];
}
/// levelFromLinear(), rounded; good to half a level.
inline std::uint8_t roundedLevelFromLinear(float linear) {
  return kSrgbTables
      .level[static_cast<std::size_t>(std::clamp(linear, 0.0F, 1.0F) * SrgbTables::kSteps)];
}

}  // namespace pleinair::hal::synthetic
