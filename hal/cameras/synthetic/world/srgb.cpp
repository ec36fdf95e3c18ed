#include "hal/cameras/synthetic/world/srgb.h"

#include <cmath>

namespace pleinair::hal::synthetic {
namespace {

float decoded(float coded) {
  return coded <= 0.04045F ? coded / 12.92F : std::pow((coded + 0.055F) / 1.055F, 2.4F);
}

float coded(float linear) {
  return linear <= 0.0031308F ? 12.92F * linear : 1.055F * std::pow(linear, 1 / 2.4F) - 0.055F;
}

}  // namespace

SrgbTables::SrgbTables() {
  for (std::size_t i = 0; i < linear.size(); ++i) {
    linear[i] = decoded(static_cast<float>(i) / 255.0F);
  }
  for (std::size_t i = 0; i <= kSteps; ++i) {
    const float middle = (static_cast<float>(i) + 0.5F) / kSteps;
    level[i] = static_cast<std::uint8_t>(levelFromLinear(middle) + 0.5F);
  }
}

glm::vec3 linearFromSrgb(std::uint32_t rrggbb) {
  const auto channel = [rrggbb](int shift) {
    return decoded(static_cast<float>((rrggbb >> shift) & 0xffU) / 255.0F);
  };
  return {channel(16), channel(8), channel(0)};
}

float levelFromLinear(float linear) {
  return 255 * coded(std::clamp(linear, 0.0F, 1.0F));
}

}  // namespace pleinair::hal::synthetic
