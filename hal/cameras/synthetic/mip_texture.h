#pragma once

#include <cstdint>
#include <vector>

#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

namespace pleinair::hal::synthetic {

/// Linear light and coverage, 65535 for 1; the colour is multiplied by the coverage.
struct Texel {
  std::uint16_t red = 0, green = 0, blue = 0, coverage = 0;
};

Texel packTexel(glm::vec4 linearPremultiplied);
glm::vec4 unpackTexel(Texel texel);

/// A picture in linear light at full, half, quarter … resolution.
class MipTexture {
 public:
  struct Level {
    int width = 0;
    int height = 0;
    std::vector<Texel> texels;  ///< row-major, packed
  };

  /// A transparent texture of at least this size, rounded up so that every level halves evenly.
  MipTexture(int minimumWidth, int minimumHeight);

  Level& base() { return levels_.front(); }
  const std::vector<Level>& levels() const { return levels_; }
  /// Makes the coarser levels, each texel the mean of the four below it.
  void buildLevels();

 private:
  std::vector<Level> levels_;
};

/// sRGB-coded 0xRRGGBB in linear light, 0 to 1 (IEC 61966-2-1).
glm::vec3 linearFromSrgb(std::uint32_t rrggbb);

}  // namespace pleinair::hal::synthetic
