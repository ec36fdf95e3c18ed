#pragma once

#include <array>
#include <cstdint>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

namespace pleinair::hal::synthetic {

/// Oiled planks along x, worn by use, with grain and a few knots. Caches the last plank, so that
/// neighbouring points are fast. One thread at a time.
class Wood {
 public:
  explicit Wood(std::uint32_t seed) : seed_(seed) {}

  /// Linear light at a point in metres.
  glm::vec3 linearRgbAt(glm::vec2 point);

 private:
  static constexpr int kKnotsAPlank = 2;
  struct Knot {
    glm::vec2 centre{0};
    float radius = 0;  ///< 0: no knot
  };
  struct Plank {
    glm::ivec2 place{-1 << 20};
    std::uint32_t id = 0;
    glm::vec3 light{0};
    float tone = 0, ringShift = 0, ringTilt = 0;
    std::array<Knot, kKnotsAPlank> knots;
  };
  void take(glm::ivec2 place);
  float bendAroundKnots(glm::vec2 p, float& y) const;
  float yearRings(glm::vec2 p, float y) const;

  std::uint32_t seed_;
  std::int32_t row_ = -1 << 20;
  float rowShift_ = 0;
  Plank plank_;
};

}  // namespace pleinair::hal::synthetic
