#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <random>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>

#include "hal/image.h"

namespace pleinair::support {

/// A face made of ellipses, which a detector takes for one.
struct DrawnFace {
  glm::dvec2 centre{160.0, 120.0};
  double side = 50.0;     ///< from the brows to the chin, px
  double contrast = 1.0;  ///< of the features with the skin

  /// Its luma in [0, 1], or `behind` outside it.
  double lumaAt(glm::dvec2 px, double behind) const {
    struct Part {
      glm::dvec2 at, radii;
      double luma;
    };
    // In heights of a head, of which a detector's square has 1.22.
    static constexpr std::array<Part, 11> kParts{{
        {{0.0, -0.12}, {0.52, 0.78}, 0.24},   // hair
        {{0.0, 0.05}, {0.44, 0.62}, 0.75},    // skin
        {{-0.2, -0.12}, {0.12, 0.07}, 0.43},  // eyes
        {{0.2, -0.12}, {0.12, 0.07}, 0.43},
        {{-0.2, -0.11}, {0.05, 0.05}, 0.12},
        {{0.2, -0.11}, {0.05, 0.05}, 0.12},
        {{-0.2, -0.22}, {0.13, 0.03}, 0.27},  // brows
        {{0.2, -0.22}, {0.13, 0.03}, 0.27},
        {{0.0, 0.12}, {0.06, 0.05}, 0.55},   // nose
        {{0.0, 0.34}, {0.16, 0.045}, 0.39},  // mouth
        {{0.0, 0.56}, {0.2, 0.02}, 0.6},     // chin
    }};
    constexpr double kSoft = 0.03;  // width of an edge
    const glm::dvec2 at = (px - centre) / (side / 1.22);
    double luma = behind;
    for (const Part& part : kParts) {
      const double beyond =
          (glm::length((at - part.at) / part.radii) - 1.0) * std::min(part.radii.x, part.radii.y);
      const double own =
          &part > &kParts[1] ? glm::mix(kParts[1].luma, part.luma, contrast) : part.luma;
      luma = glm::mix(luma, own, glm::smoothstep(kSoft, -kSoft, beyond));
    }
    return luma;
  }
};

/// Grey, RGBA8: faces before a wall with some shading, which has gone by `wallPx` to the right, and
/// noise of so many levels.
template <std::size_t count>
hal::Image drawnFaces(hal::FrameSize size, const std::array<DrawnFace, count>& faces,
                      double noiseLevels = 0.0, unsigned seed = 1, double wallPx = 0.0) {
  hal::Image image({.pixelFormat = hal::PixelFormat::kRgba8, .size = size});
  std::mt19937 random(seed);
  std::normal_distribution<double> noise(0.0, 1.0);
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x) {
      double luma = 0.5 + 0.1 * std::sin(0.02 * (x - wallPx)) * std::cos(0.03 * y);
      for (const DrawnFace& face : faces) luma = face.lumaAt({x + 0.5, y + 0.5}, luma);
      const double level = std::clamp(255.0 * luma + noiseLevels * noise(random) + 0.5, 0.0, 255.0);
      auto* const pixel = image.row(0, y).data() + std::ptrdiff_t{x} * 4;
      std::fill_n(pixel, 3, static_cast<std::uint8_t>(level));
      pixel[3] = 255;
    }
  }
  return image;
}

}  // namespace pleinair::support
