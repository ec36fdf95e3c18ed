#include "hal/cameras/synthetic/world/light.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "hal/cameras/synthetic/world/noise.h"
#include "hal/cameras/synthetic/world/occlusion.h"

namespace pleinair::hal::synthetic {
namespace {

constexpr float kPi = 3.14159265F;
constexpr float kLiftMetres = 0.0012F;  // distance of a ray's origin from its surface

// Warm against cool light: sun and lamp are warm, the sky tints every shadow blue.
const glm::vec3 kSunDirection = glm::normalize(glm::vec3(-0.80F, -0.34F, 0.40F));
constexpr glm::vec3 kSunLight{1.62F, 1.24F, 0.76F};
constexpr float kSunRadius = 0.015F;
constexpr glm::vec3 kSkyLight{1.55F, 1.80F, 2.08F};
constexpr glm::vec3 kRoomFromWindowSide{0.375F, 0.425F, 0.480F};
constexpr glm::vec3 kRoomFromElsewhere{0.290F, 0.285F, 0.275F};
constexpr glm::vec3 kRoomFromBelow{0.190F, 0.155F, 0.120F};
/// share of light that nearby surfaces reflect, in their colour
constexpr glm::vec3 kReflected{0.60F, 0.55F, 0.48F};
constexpr float kNearbyMetres = 0.55F;  // beyond this distance, light counts as the room's

/// Point `i` of n points evenly spread in the unit square, with two independent sets (R2
/// sequences).
glm::vec2 r2Point(int i, float shift) {
  const auto n = static_cast<float>(i);
  return glm::fract(glm::vec2(shift + n * 0.7548776662F, shift + n * 0.5698402910F));
}

/// Directions and origins of `kCount` rays, the same for every point.
template <int kCount>
struct Rays {
  std::array<glm::vec2, kCount> cell{};    ///< origin within the point's lattice cell, ±0.5
  std::array<glm::vec2, kCount> square{};  ///< in the unit square
  std::array<glm::vec2, kCount> disc{};    ///< in the unit disc

  Rays(float cellShift, float squareShift) {
    for (int i = 0; i < kCount; ++i) {
      const auto k = static_cast<std::size_t>(i);
      const glm::vec2 swapped = r2Point(i, cellShift) - 0.5F;
      cell[k] = {swapped.y, swapped.x};
      square[k] = r2Point(i, squareShift);
      const float angle = 2 * kPi * square[k].x;
      disc[k] = std::sqrt(square[k].y) * glm::vec2(std::cos(angle), std::sin(angle));
    }
  }
};

/// The surface tile between neighbouring lattice points, which `pointAt(x, y)` gives.
template <class PointAt>
Tile tileOf(const PointAt& pointAt, glm::ivec2 first, glm::ivec2 last) {
  const auto middle = pointAt((first.x + last.x) / 2, (first.y + last.y) / 2);
  Tile tile{.centre = middle.point, .normal = middle.normal, .isFlat = true};
  std::size_t i = 0;
  for (const int x : {first.x, last.x}) {
    for (const int y : {first.y, last.y}) {
      const auto corner = pointAt(x, y);
      tile.corners[i++] = corner.point;
      tile.radius = std::max(tile.radius, glm::distance(corner.point, tile.centre));
      tile.isFlat &= glm::dot(corner.normal, tile.normal) > 0.99999F;
    }
  }
  const float step = glm::length(middle.alongX) + glm::length(middle.alongY);
  tile.radius += step + 0.002F;
  return tile;
}

/// Two unit vectors at right angles to `normal` and to each other.
std::array<glm::vec3, 2> across(glm::vec3 normal) {
  const glm::vec3 helper = std::abs(normal.z) > 0.9F ? glm::vec3(1, 0, 0) : glm::vec3(0, 0, 1);
  const glm::vec3 first = glm::normalize(glm::cross(helper, normal));
  return {first, glm::cross(normal, first)};
}

glm::vec3 roomSeenAlong(glm::vec3 direction) {
  const float fromWindow = glm::smoothstep(-0.1F, 0.9F, -direction.x);
  const float fromBelow = glm::smoothstep(0.15F, 0.85F, -direction.z);
  return glm::mix(glm::mix(kRoomFromElsewhere, kRoomFromWindowSide, fromWindow), kRoomFromBelow,
                  fromBelow);
}

constexpr glm::vec3 kSpotlightAt{0.95F, -0.75F, 1.25F};

constexpr glm::vec3 kWindowCentre{kWindowX, -0.62F, 1.0F};
constexpr float kWindowRadius = 0.85F;
constexpr Lamp kBenchLamp{kLampAt, kLampAxis, {0.105F, 0.068F, 0.030F}, 0.035F, 0.60F, 0.90F};
/// Outside the picture, above the bench's right side; its beam falls on the right part of the wall
/// and of the bench.
const Lamp kSpotlight{kSpotlightAt,
                      glm::normalize(glm::vec3(0.58F, 0.45F, 0.08F) - kSpotlightAt),
                      {1.75F, 1.55F, 1.25F},
                      0.04F,
                      0.880F,
                      0.955F};

}  // namespace

const std::vector<Pane>& windowPanes() {
  static const std::vector<Pane> kPanes{{{-1.10F, 0.42F}, {-0.66F, 0.92F}},
                                        {{-0.60F, 0.42F}, {-0.16F, 0.92F}},
                                        {{-1.10F, 0.98F}, {-0.66F, 1.48F}},
                                        {{-0.60F, 0.98F}, {-0.16F, 1.48F}}};
  return kPanes;
}

RoomLight::RoomLight(const std::vector<Occluder>& occluders, const std::vector<glm::vec3>& colours,
                     bool hasSpotlight)
    : occluders_(occluders), lamps_{kBenchLamp} {
  if (hasSpotlight) lamps_.push_back(kSpotlight);
  for (const Occluder& occluder : occluders) {
    glm::vec3 sum(0);
    for (const std::uint16_t patch : occluder.patches) sum += colours[patch];
    occluderColours_.push_back(sum / static_cast<float>(occluder.patches.size()));
  }
}

glm::vec3 RoomLight::colourOf(const Occluder& occluder) const {
  return occluderColours_[static_cast<std::size_t>(&occluder - occluders_.data())];
}

glm::vec3 RoomLight::sunAt(const Point& at, const Near& near) const {
  constexpr int kRays = 16;
  static const Rays<kRays> kSpread(0.13F, 0.5F);
  const float facing = glm::dot(at.normal, kSunDirection);
  if (facing <= 0) return glm::vec3(0);
  const auto [right, up] = across(kSunDirection);
  int arrived = 0;
  for (std::size_t i = 0; i < kRays; ++i) {
    const glm::vec2 disc = kSunRadius * kSpread.disc[i];
    const glm::vec3 direction = kSunDirection + disc.x * right + disc.y * up;
    const glm::vec3 origin =
        at.point + kSpread.cell[i].x * at.alongX + kSpread.cell[i].y * at.alongY;
    const float t = (kWindowX - origin.x) / direction.x;
    const glm::vec2 yz = glm::vec2(origin.y, origin.z) + t * glm::vec2(direction.y, direction.z);
    const bool isThroughPane = std::ranges::any_of(windowPanes(), [yz](const Pane& pane) {
      return yz.x > pane.lowYz.x && yz.y > pane.lowYz.y && yz.x < pane.highYz.x &&
             yz.y < pane.highYz.y;
    });
    if (isThroughPane && !isBlocked(near, origin, direction, t)) ++arrived;
  }
  return kSunLight * facing * (static_cast<float>(arrived) / kRays);
}

glm::vec3 RoomLight::skyAt(const Point& at, const Near& near) const {
  constexpr int kRays = 12;
  static const Rays<kRays> kSpread(0.77F, 0.31F);
  float sum = 0;
  for (std::size_t i = 0; i < kRays; ++i) {
    const glm::vec2 on = kSpread.square[i];
    const glm::vec3 origin =
        at.point + kSpread.cell[i].x * at.alongX + kSpread.cell[i].y * at.alongY;
    const glm::vec3 to(kWindowX, glm::mix(-1.10F, -0.16F, on.x), glm::mix(0.42F, 1.48F, on.y));
    const glm::vec3 direction = to - origin;
    const float squared = glm::dot(direction, direction);
    const float facing = glm::dot(at.normal, direction);
    if (facing <= 0 || squared < 1e-4F || isBlocked(near, origin, direction, 1)) continue;
    sum += facing * -direction.x / (squared * squared);
  }
  constexpr float kArea = 0.94F * 1.06F;
  return kSkyLight * (std::max(sum, 0.0F) * kArea / (kPi * kRays));
}

glm::vec3 RoomLight::lampAt(const Lamp& lamp, const Point& at, const Near& near) const {
  constexpr int kRays = 8;
  static const Rays<kRays> kSpread(0.41F, 0.9F);
  float sum = 0;
  for (std::size_t i = 0; i < kRays; ++i) {
    const glm::vec3 origin =
        at.point + kSpread.cell[i].x * at.alongX + kSpread.cell[i].y * at.alongY;
    const glm::vec3 bulb = lamp.at + lamp.radius * glm::vec3(kSpread.disc[i], 0);
    const glm::vec3 direction = bulb - origin;
    const float distance = glm::length(direction);
    const float facing = glm::dot(at.normal, direction) / distance;
    const float beam = glm::smoothstep(lamp.edgeCosine, lamp.innerCosine,
                                       -glm::dot(lamp.axis, direction) / distance);
    if (facing <= 0 || beam <= 0 || isBlocked(near, origin, direction, 1)) continue;
    sum += facing * beam / (distance * distance);
  }
  return lamp.light * (sum / kRays);
}

glm::vec3 RoomLight::roomAt(const Point& at, const Near& near) const {
  constexpr int kRays = 20;
  static const Rays<kRays> kSpread(0.29F, 0.5F);
  const auto [right, up] = across(at.normal);
  glm::vec3 sum(0);
  for (std::size_t i = 0; i < kRays; ++i) {
    // Malley's method: an even distribution in the disc gives a cosine distribution in the
    // hemisphere.
    const glm::vec2 disc = kSpread.disc[i];
    const glm::vec3 direction =
        disc.x * right + disc.y * up + std::sqrt(1 - kSpread.square[i].y) * at.normal;
    const glm::vec3 origin =
        at.point + kSpread.cell[i].x * at.alongX + kSpread.cell[i].y * at.alongY;
    const Occluder* hit = nullptr;
    float nearest = kNearbyMetres;
    for (const Occluder* each : near) {
      const float t = entryDistance(*each, origin, direction);
      if (t < nearest) {
        nearest = t;
        hit = each;
      }
    }
    const glm::vec3 room = roomSeenAlong(direction);
    if (hit == nullptr) {
      sum += room;
      continue;
    }
    const float farness = glm::smoothstep(0.35F * kNearbyMetres, kNearbyMetres, nearest);
    sum += glm::mix(colourOf(*hit) * kReflected, room, farness);
  }
  return sum * (1.0F / kRays);
}

RoomLight::Lattice RoomLight::on(const Patch& patch) const {
  constexpr int kTile = 8;
  const glm::vec2 cells =
      glm::max(glm::ceil(2.0F * patch.half / static_cast<float>(patch.lightStep)), glm::vec2(2));
  Lattice lattice{static_cast<int>(cells.x) + 1, static_cast<int>(cells.y) + 1, {}};
  const auto columns = static_cast<std::size_t>(lattice.columns);
  lattice.linearRgb.resize(columns * static_cast<std::size_t>(lattice.rows));
  std::vector<bool> isCovered(lattice.linearRgb.size());
  const glm::vec2 step = 2.0F * patch.half / cells;
  const auto pointAt = [&](int x, int y) {
    const glm::vec2 at = -patch.half + step * glm::vec2(x, y);
    const PointAndNormal surface = patch.at(at);
    const glm::vec3 alongX(patch.at(at + glm::vec2(step.x, 0)).point - surface.point);
    const glm::vec3 alongY(patch.at(at + glm::vec2(0, step.y)).point - surface.point);
    // At the rims of the patch, rays start on the patch.
    const auto half = [](int i, int end) { return i == 0 || i == end - 1 ? 0.0F : 1.0F; };
    const glm::vec3 normal(surface.normal);
    return Point{glm::vec3(surface.point) + kLiftMetres * normal, normal,
                 alongX * half(x, lattice.columns), alongY * half(y, lattice.rows)};
  };
  Near all;
  for (const Occluder& each : occluders_) all.push_back(&each);
  for (int tileY = 0; tileY < lattice.rows; tileY += kTile) {
    for (int tileX = 0; tileX < lattice.columns; tileX += kTile) {
      const int endX = std::min(tileX + kTile, lattice.columns);
      const int endY = std::min(tileY + kTile, lattice.rows);
      const Tile tile = tileOf(pointAt, {tileX, tileY}, {endX - 1, endY - 1});
      const Near sun =
          between(all, tile, tile.centre + 3.0F * kSunDirection, tile.radius + 3.0F * kSunRadius);
      const Near sky = between(all, tile, kWindowCentre, kWindowRadius);
      std::vector<Near> nearLamps;
      for (const Lamp& lamp : lamps_) {
        nearLamps.push_back(between(all, tile, lamp.at, 2 * lamp.radius));
      }
      const Near nearby = around(all, tile, kNearbyMetres);
      for (int y = tileY; y < endY; ++y) {
        for (int x = tileX; x < endX; ++x) {
          const Point at = pointAt(x, y);
          const std::size_t i = static_cast<std::size_t>(y) * columns + static_cast<std::size_t>(x);
          isCovered[i] = std::ranges::any_of(
              nearby, [&at](const Occluder* each) { return isInside(*each, at.point); });
          if (isCovered[i]) continue;
          glm::vec3 light = sunAt(at, sun) + skyAt(at, sky);
          for (std::size_t lamp = 0; lamp < lamps_.size(); ++lamp) {
            light += lampAt(lamps_[lamp], at, nearLamps[lamp]);
          }
          lattice.linearRgb[i] = light + roomAt(at, nearby);
        }
      }
    }
  }
  // Covered points take their neighbours' light, so that no darkness bleeds out from under objects.
  for (int pass = 0; pass < 2; ++pass) {
    const std::vector<bool> covered = isCovered;
    for (int y = 0; y < lattice.rows; ++y) {
      for (int x = 0; x < lattice.columns; ++x) {
        const std::size_t i = static_cast<std::size_t>(y) * columns + static_cast<std::size_t>(x);
        if (!covered[i]) continue;
        glm::vec3 sum(0);
        float count = 0;
        for (int dy = -1; dy <= 1; ++dy) {
          for (int dx = -1; dx <= 1; ++dx) {
            if (x + dx < 0 || y + dy < 0 || x + dx >= lattice.columns || y + dy >= lattice.rows) {
              continue;
            }
            const std::size_t j =
                static_cast<std::size_t>(y + dy) * columns + static_cast<std::size_t>(x + dx);
            if (covered[j]) continue;
            sum += lattice.linearRgb[j];
            ++count;
          }
        }
        if (count == 0) continue;
        lattice.linearRgb[i] = sum / count;
        isCovered[i] = false;
      }
    }
  }
  return lattice;
}

namespace {

/// Compresses highlights smoothly, as film does, so that paper in the sun keeps its hue.
float toneMapped(float light) {
  constexpr float kShoulder = 0.60F;
  if (light <= kShoulder) return light;
  return 1 - (1 - kShoulder) * std::exp((kShoulder - light) / (1 - kShoulder));
}

/// A lookup table of toneMapped().
class ToneCurve {
 public:
  ToneCurve() {
    for (std::size_t i = 0; i < table_.size(); ++i) {
      table_[i] = toneMapped(static_cast<float>(i) / kSteps);
    }
  }
  float operator()(float light) const {
    return table_[static_cast<std::size_t>(std::min(light, kMost) * kSteps)];
  }

 private:
  static constexpr float kMost = 4;
  static constexpr float kSteps = 4096;
  std::array<float, static_cast<std::size_t>(kMost* kSteps) + 1> table_{};
};

}  // namespace

void applyLight(const RoomLight::Lattice& light, glm::vec2 half, float texelMetres,
                MipTexture::Level& level) {
  static const ToneCurve kToneCurve;
  const auto columns = static_cast<std::size_t>(light.columns);
  const glm::vec2 scale = glm::vec2(light.columns - 1, light.rows - 1) / (2.0F * half);
  const auto place = [texelMetres](int texel, float perMetre, int points) {
    return glm::clamp((static_cast<float>(texel) + 0.5F) * texelMetres * perMetre, 0.0F,
                      static_cast<float>(points) - 1.001F);
  };
  std::vector<glm::vec3> line(columns);
  std::uint32_t dither = 0x9e3779b9U;
  for (int row = 0; row < level.height; ++row) {
    const float fy = place(row, scale.y, light.rows);
    const auto y = static_cast<std::size_t>(fy);
    const float ty = fy - static_cast<float>(y);
    for (std::size_t x = 0; x < columns; ++x) {
      line[x] =
          glm::mix(light.linearRgb[y * columns + x], light.linearRgb[(y + 1) * columns + x], ty);
    }
    Texel* texel = level.texels.data() + std::ptrdiff_t{row} * level.width;
    for (int column = 0; column < level.width; ++column, ++texel) {
      const float fx = place(column, scale.x, light.columns);
      const auto x = static_cast<std::size_t>(fx);
      const glm::vec3 there = glm::mix(line[x], line[x + 1], fx - static_cast<float>(x));
      dither = dither * 1664525U + 1013904223U;
      const float jitter = 1 + 0.006F * (static_cast<float>(dither >> 16) / 65536.0F - 0.5F);
      const glm::vec3 lit = linearRgbOf(*texel) * there * jitter;
      *texel = codedTexel({kToneCurve(lit.r), kToneCurve(lit.g), kToneCurve(lit.b)});
    }
  }
}

}  // namespace pleinair::hal::synthetic
