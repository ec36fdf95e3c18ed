#include "hal/cameras/synthetic/renderer.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <utility>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>

#include "hal/cameras/synthetic/desk_world.h"

namespace pleinair::hal::synthetic {
namespace {

// The compilers' portable vectors: SSE and NEON alike.
using Float4 = float __attribute__((vector_size(16)));
using Word4 = std::uint16_t __attribute__((vector_size(8)));
static_assert(sizeof(Texel) == sizeof(Word4));

/// A little below the footprint's own level: crisper, and the two taps keep it from shimmering.
constexpr float kLevelBias = -0.35F;

Float4 load(const Texel& texel) {
  Word4 words;
  std::memcpy(&words, &texel, sizeof(words));
  return __builtin_convertvector(words, Float4);
}

/// Bilinear; `p` in this level's texels, outer corner at 0. Beyond the border the border goes on.
Float4 sampleLevel(const MipTexture::Level& level, glm::vec2 p) {
  const float x = std::clamp(p.x - 0.5F, 0.0F, static_cast<float>(level.width) - 1.01F);
  const float y = std::clamp(p.y - 0.5F, 0.0F, static_cast<float>(level.height) - 1.01F);
  const auto column = static_cast<int>(x);
  const auto row = static_cast<int>(y);
  const float tx = x - static_cast<float>(column);
  const float ty = y - static_cast<float>(row);
  const Texel* texel = level.texels.data() + std::ptrdiff_t{row} * level.width + column;
  const Float4 near = load(texel[0]) * (1 - tx) + load(texel[1]) * tx;
  const Texel* below = texel + level.width;
  const Float4 far = load(below[0]) * (1 - tx) + load(below[1]) * tx;
  return near * (1 - ty) + far * ty;
}

/// Trilinear; `p` in the finest level's texels, `lod` in levels.
Float4 sample(const MipTexture& texture, glm::vec2 p, float lod) {
  const auto& levels = texture.levels();
  const float clamped = std::clamp(lod, 0.0F, static_cast<float>(levels.size()) - 1.01F);
  const auto fine = static_cast<std::size_t>(clamped);
  const float t = clamped - static_cast<float>(fine);
  const glm::vec2 atFine = p / static_cast<float>(1U << fine);
  return sampleLevel(levels[fine], atFine) * (1 - t) +
         sampleLevel(levels[fine + 1], atFine / 2.0F) * t;
}

/// The ray's foot on a plane this far below the eye, with its derivatives by the pixel's x and y.
struct Foot {
  glm::vec2 point{0};
  glm::vec2 alongX{0};
  glm::vec2 alongY{0};
};

struct RowRays {
  glm::vec3 eye{0};
  glm::vec3 first{0};    ///< direction through the row's first pixel centre
  glm::vec3 acrossX{0};  ///< its change from pixel to pixel
  glm::vec3 acrossY{0};  ///< its change from row to row

  Foot footOf(glm::vec3 direction, float depthBelowEye) const {
    const float t = -depthBelowEye / direction.z;
    const glm::vec2 slope = glm::vec2(direction) / direction.z;
    return {glm::vec2(eye) + glm::vec2(direction) * t, (glm::vec2(acrossX) - slope * acrossX.z) * t,
            (glm::vec2(acrossY) - slope * acrossY.z) * t};
  }
};

RowRays raysOfRow(const CameraView& view, int y) {
  const Ray first = view.through({0.5, y + 0.5});
  const Ray right = view.through({1.5, y + 0.5});
  const Ray below = view.through({0.5, y + 1.5});
  return {glm::vec3(first.origin), glm::vec3(first.direction),
          glm::vec3(right.direction - first.direction),
          glm::vec3(below.direction - first.direction)};
}

/// Premultiplied linear light and coverage, 65535 for 1.
Float4 deskUnder(const DeskPicture& desk, const Foot& foot) {
  const auto texelsAMetre = static_cast<float>(1 / desk.texelMetres);
  const glm::vec2 p = (foot.point - glm::vec2(desk.originMetres)) * texelsAMetre;
  const MipTexture::Level& base = desk.texture.levels().front();
  const bool isOutside = !(p.x >= 0 && p.y >= 0 && p.x <= static_cast<float>(base.width) &&
                           p.y <= static_cast<float>(base.height));
  if (isOutside) return Float4{};
  glm::vec2 longer = foot.alongX * texelsAMetre;
  glm::vec2 shorter = foot.alongY * texelsAMetre;
  if (glm::dot(longer, longer) < glm::dot(shorter, shorter)) std::swap(longer, shorter);
  const float footprint =
      std::max(glm::dot(shorter, shorter), glm::dot(longer, longer) / 4);  // squared, texels
  const float lod = 0.5F * std::log2(footprint) + kLevelBias;
  return 0.5F * (sample(desk.texture, p - 0.25F * longer, lod) +
                 sample(desk.texture, p + 0.25F * longer, lod));
}

}  // namespace

Renderer::Renderer(std::shared_ptr<const DeskPicture> desk) : desk_(std::move(desk)) {}

void Renderer::renderRow(const CameraView& view, int y, std::span<glm::vec3> linearRgb) const {
  const RowRays rays = raysOfRow(view, y);
  for (std::size_t x = 0; x < linearRgb.size(); ++x) {
    const glm::vec3 direction = rays.first + static_cast<float>(x) * rays.acrossX;
    if (direction.z >= 0) {
      linearRgb[x] = hazeLinearRgb();
      continue;
    }
    const Float4 desk = deskUnder(*desk_, rays.footOf(direction, rays.eye.z)) / 65535.0F;
    glm::vec3 rgb(desk[0], desk[1], desk[2]);
    if (desk[3] < 0.9999F) {
      const Foot floor = rays.footOf(direction, rays.eye.z - static_cast<float>(kFloorZ));
      rgb += (1 - desk[3]) * floorLinearRgb(floor.point);
    }
    linearRgb[x] = rgb;
  }
}

}  // namespace pleinair::hal::synthetic
