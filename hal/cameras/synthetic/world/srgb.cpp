#include "hal/cameras/synthetic/world/srgb.h"

#include "hal/linear_light.h"

namespace pleinair::hal::synthetic {

SrgbTables::SrgbTables() {
  for (std::size_t i = 0; i < linear.size(); ++i) {
    linear[i] = hal::linearFromSrgb(static_cast<float>(i) / 255.0F);
  }
  for (std::size_t i = 0; i <= kSteps; ++i) {
    const float middle = (static_cast<float>(i) + 0.5F) / kSteps;
    // NOLINTNEXTLINE(bugprone-incorrect-roundings): never negative
    level[i] = static_cast<std::uint8_t>(levelFromLinear(middle) + 0.5F);
  }
}

glm::vec3 linearFromSrgb(std::uint32_t rrggbb) {
  const auto channel = [rrggbb](int shift) {
    return hal::linearFromSrgb(static_cast<float>((rrggbb >> shift) & 0xffU) / 255.0F);
  };
  return {channel(16), channel(8), channel(0)};
}

float levelFromLinear(float linear) {
  return 255 * srgbFromLinear(std::clamp(linear, 0.0F, 1.0F));
}

}  // namespace pleinair::hal::synthetic
