#include "hal/cameras/synthetic/world/wood.h"

#include <cmath>

#include <glm/common.hpp>

#include "hal/cameras/synthetic/world/noise.h"
#include "hal/cameras/synthetic/world/srgb.h"

namespace pleinair::hal::synthetic {
namespace {

constexpr float kPlankWidth = 0.184F;
constexpr float kPlankLength = 2.60F;
constexpr float kRingSpacing = 0.0135F;

float random(std::uint32_t id, std::uint32_t index) {
  return static_cast<float>(unitRandom(id, index));
}

}  // namespace

void Wood::take(glm::ivec2 place) {
  static const glm::vec3 kLight = linearFromSrgb(0xcaa273);
  static const glm::vec3 kReddish = linearFromSrgb(0xb98c5e);
  const auto rowId = static_cast<std::uint32_t>(place.y);
  const auto columnId = static_cast<std::uint32_t>(place.x);
  plank_.place = place;
  plank_.id = static_cast<std::uint32_t>(mixBits(mixBits(seed_ ^ rowId) + columnId));
  plank_.light = glm::mix(kLight, kReddish, random(plank_.id, 3) * 0.8F);
  plank_.tone = 0.90F + 0.18F * random(plank_.id, 4);
  plank_.ringShift = 0.16F * (random(plank_.id, 1) - 0.5F);
  plank_.ringTilt = 0.07F * (random(plank_.id, 2) - 0.5F);
  for (std::uint32_t i = 0; i < kKnotsAPlank; ++i) {
    plank_.knots[i] = {
        {kPlankLength * 0.9F * (random(plank_.id, 40 + i) - 0.5F),
         kPlankWidth * 0.6F * (random(plank_.id, 50 + i) - 0.5F)},
        random(plank_.id, 20 + i) < 0.45F ? 0.0F : 0.005F + 0.007F * random(plank_.id, 30 + i)};
  }
}

/// Bends the grain around the plank's knots and gives the point's depth inside a knot.
float Wood::bendAroundKnots(glm::vec2 p, float& y) const {
  float inKnot = 0;
  for (const Knot& knot : plank_.knots) {
    if (knot.radius == 0) continue;
    const glm::vec2 d = (p - knot.centre) / knot.radius;
    if (std::abs(d.x) > 14 || std::abs(d.y) > 8) continue;
    const float bend = std::exp(-(d.x * d.x / 18 + d.y * d.y / 5));
    y += (d.y / (std::abs(d.y) + 0.5F)) * knot.radius * 1.3F * bend;
    inKnot = std::max(inKnot,
                      1 - glm::smoothstep(0.55F, 1.15F, std::sqrt(d.x * d.x * 0.55F + d.y * d.y)));
  }
  return inKnot;
}

/// Darkness of the year rings: 0 in early wood, 1 in the dark line that ends a year.
float Wood::yearRings(glm::vec2 p, float y) const {
  const float warp = fractalNoise(plank_.id, {p.x * 2.1F, p.y * 9}, 2) - 0.5F;
  const float acrossMetres = y + plank_.ringShift + 0.022F * warp;
  const float depthMetres = 0.035F + p.x * plank_.ringTilt;
  const float rings =
      std::sqrt(acrossMetres * acrossMetres + depthMetres * depthMetres) / kRingSpacing;
  const float phase = rings - std::floor(rings);
  return glm::smoothstep(0.1F, 0.85F, phase) * (1 - glm::smoothstep(0.86F, 1.0F, phase));
}

glm::vec3 Wood::linearRgbAt(glm::vec2 point) {
  static const glm::vec3 kDark = linearFromSrgb(0xa2774b);
  static const glm::vec3 kKnot = linearFromSrgb(0x5a3a22);
  const float row = std::floor(point.y / kPlankWidth);
  if (static_cast<std::int32_t>(row) != row_) {
    row_ = static_cast<std::int32_t>(row);
    rowShift_ = kPlankLength * random(seed_ ^ 0x51U, static_cast<std::uint32_t>(row_));
  }
  const float along = point.x + rowShift_;
  const float column = std::floor(along / kPlankLength);
  const glm::ivec2 place(static_cast<std::int32_t>(column), row_);
  if (place != plank_.place) take(place);
  const glm::vec2 p(along - (column + 0.5F) * kPlankLength, point.y - (row + 0.5F) * kPlankWidth);
  const float toNeighbour =
      std::min(kPlankLength / 2 - std::abs(p.x), kPlankWidth / 2 - std::abs(p.y));

  float y = p.y;
  const float inKnot = bendAroundKnots(p, y);
  const float ring = yearRings(p, y);
  const float streak = fractalNoise(plank_.id + 2, {p.x * 1.5F, y * 34}, 2) - 0.5F;
  glm::vec3 rgb =
      glm::mix(plank_.light, kDark, glm::clamp(0.30F * ring + 0.26F * streak + 0.14F, 0.F, 1.F));
  rgb *= plank_.tone;
  rgb = glm::mix(rgb, kKnot * (0.8F + 0.6F * ring), 0.8F * inKnot);

  const float groove = 1 - glm::smoothstep(0.0006F, 0.0020F, toNeighbour);
  const float bevel = 1 - glm::smoothstep(0.0020F, 0.0060F, toNeighbour);
  return rgb * (1 - 0.72F * groove) * (1 - 0.14F * bevel);
}

}  // namespace pleinair::hal::synthetic
