#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "hal/image.h"

namespace pleinair::golden {

/// A still life made by code: a wall in the sun, a table, an orange and a blue jug.
inline hal::Image stillLife() {
  constexpr hal::FrameSize kPicture{320, 240};
  hal::Image image({.pixelFormat = hal::PixelFormat::kRgba8, .size = kPicture});
  for (int y = 0; y < kPicture.height; ++y) {
    auto* p = image.row(0, y).data();
    for (int x = 0; x < kPicture.width; ++x, p += 4) {
      const bool table = y > 160 + (x - 160) / 20;
      glm::dvec3 colour = table ? glm::dvec3(150, 100, 65) * 0.75
                                : glm::dvec3(235, 225, 190) * (1.0 - 0.4 * x / kPicture.width);
      const auto ball = [&](glm::dvec2 middle, glm::dvec2 radii, glm::dvec3 own) {
        const glm::dvec2 at = (glm::dvec2(x, y) - middle) / radii;
        const double squared = at.x * at.x + at.y * at.y;
        if (squared > 1.0) return;
        const double lit = std::sqrt(1.0 - squared) * 0.6 - at.x * 0.5 - at.y * 0.5;
        colour = own * (0.35 + 0.75 * std::max(0.0, lit));
      };
      ball({225, 130}, {45, 70}, {60, 90, 170});
      ball({110, 165}, {38, 36}, {240, 140, 30});
      for (int c = 0; c < 3; ++c) {
        p[c] = static_cast<std::uint8_t>(std::clamp(colour[c], 0.0, 255.0));
      }
      p[3] = 255;
    }
  }
  return image;
}

}  // namespace pleinair::golden
