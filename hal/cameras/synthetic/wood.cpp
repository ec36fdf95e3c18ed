#include "hal/cameras/synthetic/wood.h"

#include <cmath>

#include <glm/common.hpp>

#include "hal/cameras/synthetic/noise.h"
#include "hal/cameras/synthetic/srgb.h"

namespace pleinair::hal::synthetic {
namespace {

constexpr float kPlankWidth = 0.184F;
constexpr float kPlankLength = 2.60F;
constexpr float kRingSpacing = 0.0105F;
constexpr int kKnotsAPlank = 2;

struct Plank {
  std::uint32_t id = 0;
  glm::vec2 point{0};     ///< metres from the plank's centre
  float toNeighbour = 0;  ///< distance to the nearest joint
};

float random(std::uint32_t id, std::uint32_t index) {
  return static_cast<float>(unitRandom(id, index));
}

Plank plankAt(std::uint32_t seed, glm::vec2 point) {
  const float row = std::floor(point.y / kPlankWidth);
  const auto rowId = static_cast<std::uint32_t>(static_cast<std::int32_t>(row));
  const float along = point.x + kPlankLength * random(seed ^ 0x51U, rowId);
  const float column = std::floor(along / kPlankLength);
  const auto columnId = static_cast<std::uint32_t>(static_cast<std::int32_t>(column));
  Plank plank;
  plank.id = static_cast<std::uint32_t>(mixBits(mixBits(seed ^ rowId) + columnId));
  plank.point = {along - (column + 0.5F) * kPlankLength, point.y - (row + 0.5F) * kPlankWidth};
  plank.toNeighbour = std::min(kPlankLength / 2 - std::abs(plank.point.x),
                               kPlankWidth / 2 - std::abs(plank.point.y));
  return plank;
}

/// Bends the grain around the plank's knots and says how deep inside one the point lies.
float bendAroundKnots(const Plank& plank, float& y) {
  float inKnot = 0;
  for (std::uint32_t knot = 0; knot < kKnotsAPlank; ++knot) {
    if (random(plank.id, 20 + knot) < 0.45F) continue;
    const float radius = 0.005F + 0.007F * random(plank.id, 30 + knot);
    const glm::vec2 centre(kPlankLength * 0.9F * (random(plank.id, 40 + knot) - 0.5F),
                           kPlankWidth * 0.6F * (random(plank.id, 50 + knot) - 0.5F));
    const glm::vec2 d = (plank.point - centre) / radius;
    if (std::abs(d.x) > 14 || std::abs(d.y) > 8) continue;
    const float bend = std::exp(-(d.x * d.x / 18 + d.y * d.y / 5));
    y += (d.y / (std::abs(d.y) + 0.5F)) * radius * 1.3F * bend;
    inKnot = std::max(inKnot,
                      1 - glm::smoothstep(0.55F, 1.15F, std::sqrt(d.x * d.x * 0.55F + d.y * d.y)));
  }
  return inKnot;
}

/// 0 in early wood, 1 in the dark line that ends a year.
float yearRings(const Plank& plank, float y) {
  const glm::vec2 p = plank.point;
  const float warp = fractalNoise(plank.id, {p.x * 2.1F, p.y * 9}, 3) - 0.5F;
  const float acrossMetres = y + 0.16F * (random(plank.id, 1) - 0.5F) + 0.022F * warp;
  const float depthMetres = 0.035F + p.x * 0.07F * (random(plank.id, 2) - 0.5F) +
                            0.03F * (valueNoise(plank.id + 7, {p.x * 1.6F, 0}) - 0.5F);
  const float rings =
      std::sqrt(acrossMetres * acrossMetres + depthMetres * depthMetres) / kRingSpacing;
  const float phase = rings - std::floor(rings);
  return glm::smoothstep(0.1F, 0.85F, phase) * (1 - glm::smoothstep(0.86F, 1.0F, phase));
}

}  // namespace

glm::vec3 woodLinearRgb(std::uint32_t seed, glm::vec2 point) {
  static const glm::vec3 kLight = linearFromSrgb(0xcf9d66);
  static const glm::vec3 kDark = linearFromSrgb(0xa4703f);
  static const glm::vec3 kReddish = linearFromSrgb(0xbb8250);
  static const glm::vec3 kKnot = linearFromSrgb(0x5a3820);
  const Plank plank = plankAt(seed, point);
  const glm::vec2 p = plank.point;

  float y = p.y;
  const float inKnot = bendAroundKnots(plank, y);
  const float ring = yearRings(plank, y);
  const float streak = fractalNoise(plank.id + 2, {p.x * 2, y * 60}, 2) - 0.5F;

  const glm::vec3 light = glm::mix(kLight, kReddish, random(plank.id, 3) * 0.8F);
  glm::vec3 rgb =
      glm::mix(light, kDark, glm::clamp(0.34F * ring + 0.40F * streak + 0.14F, 0.F, 1.F));
  rgb *= 0.90F + 0.18F * random(plank.id, 4);
  rgb = glm::mix(rgb, kKnot * (0.8F + 0.6F * ring), 0.8F * inKnot);

  const float groove = 1 - glm::smoothstep(0.0006F, 0.0020F, plank.toNeighbour);
  const float bevel = 1 - glm::smoothstep(0.0020F, 0.0060F, plank.toNeighbour);
  return rgb * (1 - 0.72F * groove) * (1 - 0.14F * bevel);
}

}  // namespace pleinair::hal::synthetic
