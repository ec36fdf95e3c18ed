#pragma once

#include <cstdint>
#include <vector>

#include <glm/vec3.hpp>

#include "hal/cameras/synthetic/world/srgb.h"

namespace pleinair::hal::synthetic {

/// An sRGB-coded texel.
struct Texel {
  std::uint8_t red = 0, green = 0, blue = 0, unused = 0;
};

inline Texel codedTexel(glm::vec3 linearRgb) {
  return {roundedLevelFromLinear(linearRgb.r), roundedLevelFromLinear(linearRgb.g),
          roundedLevelFromLinear(linearRgb.b)};
}
inline glm::vec3 linearRgbOf(Texel texel) {
  return {linearFromLevel(texel.red), linearFromLevel(texel.green), linearFromLevel(texel.blue)};
}

/// An image at full, half, quarter … resolution.
class MipTexture {
 public:
  struct Level {
    int width = 0;
    int height = 0;
    std::vector<Texel> texels;  ///< row-major, packed
  };

  /// A black texture of at least 2 × 2 texels.
  MipTexture(int width, int height);

  Level& base() { return levels_.front(); }
  const std::vector<Level>& levels() const { return levels_; }
  /// Makes the coarser levels: each texel is the mean, in linear light, of four texels of the finer
  /// level. An odd level's last row or column counts twice. No level is smaller than 2 × 2.
  void buildLevels();

 private:
  std::vector<Level> levels_;
};

}  // namespace pleinair::hal::synthetic
