#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <random>

#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "hal/image.h"

namespace pleinair::marks {

/// A wall, and a disc before it.
struct View {
  glm::dvec2 shift{0.0};
  double noiseSigma = 2.0;
  double light = 1.0;
  glm::dvec2 disc{0.0};
  double radius = 0.0;
};

inline hal::Image seen(const View& view, hal::FrameSize size, unsigned seed) {
  hal::Image image({.pixelFormat = hal::PixelFormat::kRgba8, .size = size});
  std::mt19937 random(seed);
  std::normal_distribution<double> noise(0.0, view.noiseSigma);
  for (int y = 0; y < size.height; ++y) {
    std::uint8_t* p = image.row(0, y).data();
    for (int x = 0; x < size.width; ++x, p += 4) {
      const glm::dvec2 at = glm::dvec2(x, y) - view.shift;
      const double wall = 120.0 + 50.0 * std::sin(0.21 * at.x + 1.3 * std::sin(0.07 * at.y)) +
                          30.0 * std::cos(0.33 * at.y);
      const bool isDisc = glm::distance(glm::dvec2(x, y), view.disc) < view.radius;
      const glm::dvec3 colour = isDisc ? glm::dvec3(240.0, 120.0, 20.0) : glm::dvec3(wall);
      const double trembles = noise(random);
      for (int c = 0; c < 3; ++c) {
        p[c] = static_cast<std::uint8_t>(
            std::clamp(view.light * colour[c] + trembles + 0.5, 0.0, 255.0));
      }
      p[3] = 255;
    }
  }
  return image;
}

}  // namespace pleinair::marks
