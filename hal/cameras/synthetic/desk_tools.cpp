#include "hal/cameras/synthetic/desk_tools.h"

#include <array>
#include <cmath>

#include "hal/cameras/synthetic/noise.h"

namespace pleinair::hal::synthetic {
namespace {

/// Distance to the nearest line of a grid through the origin, less half the line's width.
float gridDistance(glm::vec2 p, float spacing, float width) {
  const glm::vec2 fromLine = glm::abs(p - spacing * glm::round(p / spacing));
  return std::min(fromLine.x, fromLine.y) - width / 2;
}

/// Brightness across a lying cylinder, lit from the far left.
float cylinderLight(float acrossOverRadius) {
  const float lit = glm::clamp(acrossOverRadius * 0.75F + 0.35F, -1.0F, 1.0F);
  const float gloss = std::exp(-(acrossOverRadius - 0.42F) * (acrossOverRadius - 0.42F) * 40);
  return 0.72F + 0.38F * lit + 0.5F * gloss;
}

}  // namespace

void paintCuttingMat(DeskCanvas& canvas, const Placement& at) {
  const glm::vec2 half(0.23F, 0.16F);
  const glm::vec3 green = linearFromSrgb(0x1f6f5c), line = linearFromSrgb(0xcfe0b0);
  canvas.shadow(at, half, 0.008F, 0.003F);
  canvas.paint(at, half + canvas.texelMetres(), [&](glm::vec2 p) {
    const float grain = 0.93F + 0.14F * valueNoise(401, p * 700.0F);
    const float worn = 0.92F + 0.16F * fractalNoise(402, p * 14.0F, 2);
    Paint top = canvas.fill(green * grain * worn, boxDistance(p, half, 0.008F));
    const float frame = boxDistance(p, {0.21F, 0.14F});
    top = over(canvas.fill(line, std::max(gridDistance(p, 0.01F, 0.0005F), frame), 0.30F), top);
    top = over(canvas.fill(line, std::max(gridDistance(p, 0.05F, 0.0009F), frame), 0.60F), top);
    top = over(canvas.fill(line, std::abs(frame) - 0.0007F, 0.85F), top);
    const float ray = std::abs(p.y - 0.57735F * (p.x + 0.21F) + 0.14F) * 0.866F - 0.0005F;
    return over(canvas.fill(line, std::max(ray, frame), 0.5F), top);
  });
}

void paintRule(DeskCanvas& canvas, const Placement& at) {
  const glm::vec2 half(0.155F, 0.016F);
  const glm::vec3 wood = linearFromSrgb(0xf0cf6a), ink = linearFromSrgb(0x2c2418);
  canvas.shadow(at, half, 0.001F, 0.003F);
  canvas.paint(at, half + canvas.texelMetres(), [&](glm::vec2 p) {
    const float grain = 0.94F + 0.12F * valueNoise(403, {p.x * 20, p.y * 700});
    Paint top = canvas.fill(wood * grain, boxDistance(p, half, 0.001F));
    const float tick = std::round(p.x / 0.005F);
    const bool centimetre = std::fmod(std::abs(tick), 2.0F) < 0.5F;
    const float fromTick = std::abs(p.x - tick * 0.005F) - 0.0004F;
    const float below = half.y - (centimetre ? 0.010F : 0.006F) - p.y;
    const float within = std::max({fromTick, below, std::abs(p.x) - 0.1505F});
    top = over(canvas.fill(ink, within, 0.9F), top);
    return over(canvas.fill(linearFromSrgb(0xb0332a), std::abs(p.y + 0.009F) - 0.0012F), top);
  });
}

void paintPencil(DeskCanvas& canvas, const Placement& at, std::uint32_t srgb) {
  constexpr float kRadius = 0.0038F;
  constexpr float kHalfLength = 0.085F;
  constexpr float kCone = 0.020F;
  const glm::vec3 colour = linearFromSrgb(srgb), wood = linearFromSrgb(0xe2bd8a);
  canvas.shadow(at, {kHalfLength - 0.004F, kRadius}, kRadius, 0.005F);
  canvas.paint(at, glm::vec2(kHalfLength, kRadius) + canvas.texelMetres(), [&](glm::vec2 p) {
    const float fromTip = kHalfLength - p.x;
    const float radius = kRadius * glm::clamp(fromTip / kCone, 0.0F, 1.0F);
    const float across = radius > 0 ? p.y / radius : 0.0F;
    const float facet =
        0.80F + 0.32F * glm::clamp(std::round(across * 1.5F) * 0.6F + 0.3F, -1.F, 1.F);
    const float scallop = kCone - 0.003F * std::abs(std::cos(across * 4.7F));
    glm::vec3 rgb = colour * facet;
    if (fromTip < scallop) rgb = wood * cylinderLight(across);
    if (fromTip < 0.007F) rgb = colour * 0.8F;
    if (p.x < -kHalfLength + 0.006F) rgb = linearFromSrgb(0xf2ead8) * facet;
    return canvas.fill(rgb, std::max(std::abs(p.y) - radius, std::abs(p.x) - kHalfLength));
  });
}

void paintBrush(DeskCanvas& canvas, const Placement& at, std::uint32_t srgb) {
  const glm::vec3 handle = linearFromSrgb(0x8e2323), steel = linearFromSrgb(0xc4c7cc),
                  hair = linearFromSrgb(0x7b4a24), colour = linearFromSrgb(srgb);
  canvas.shadow(at, {0.100F, 0.004F}, 0.004F, 0.005F);
  canvas.paint(at, glm::vec2(0.105F, 0.0075F) + canvas.texelMetres(), [&](glm::vec2 p) {
    float radius = 0.0022F + 0.0026F * glm::smoothstep(-0.105F, 0.02F, p.x);
    glm::vec3 rgb = handle;
    if (p.x > 0.035F) {
      rgb = steel * (std::abs(p.x - 0.050F) < 0.0012F ? 0.6F : 1.0F);
      radius = 0.0045F;
    }
    if (p.x > 0.068F) {
      const float t = (p.x - 0.068F) / 0.037F;
      radius = 0.0045F * (1 + 0.9F * t) * std::sqrt(std::max(0.0F, 1 - t * t));
      rgb = glm::mix(hair, colour, glm::smoothstep(0.25F, 0.55F, t));
    }
    const float across = radius > 0 ? p.y / radius : 0.0F;
    return canvas.fill(rgb * cylinderLight(across),
                       std::max(std::abs(p.y) - radius, std::abs(p.x) - 0.105F));
  });
}

void paintPaintBox(DeskCanvas& canvas, const Placement& at) {
  const glm::vec2 half(0.112F, 0.046F);
  constexpr std::array<std::uint32_t, 12> kPans{0xf4d43b, 0xee9a2a, 0xd93a2b, 0xb0244f,
                                                0x7b3f98, 0x2b4aa0, 0x2e86c9, 0x1f9a93,
                                                0x3d8b40, 0x93a83a, 0x8a4b2a, 0x2d2a2e};
  const glm::vec3 tin = linearFromSrgb(0xe9e7e2), well = linearFromSrgb(0x9b9a97);
  canvas.shadow(at, half, 0.006F, 0.010F);
  canvas.paint(at, half + canvas.texelMetres(), [&](glm::vec2 p) {
    const float edge = boxDistance(p, half, 0.006F);
    const float lip = glm::smoothstep(-0.0035F, -0.0025F, edge) * 0.25F;
    Paint top = canvas.fill(tin * (0.95F - lip * (p.y < p.x * 0.2F ? 1.0F : -0.2F)), edge);
    for (std::size_t pan = 0; pan < kPans.size(); ++pan) {
      const glm::vec2 q = p - glm::vec2(-0.0875F + 0.035F * static_cast<float>(pan % 6),
                                        pan < 6 ? 0.021F : -0.021F);
      const float rim = boxDistance(q, {0.0155F, 0.0185F}, 0.003F);
      if (rim > canvas.texelMetres()) continue;
      const float dip = discDistance(q - glm::vec2(0.002F, -0.003F), 0.009F);
      const float wet =
          0.82F + 0.36F * valueNoise(410U + static_cast<std::uint32_t>(pan), q * 160.F);
      const float gloss = std::exp(
          -glm::dot(q - glm::vec2(-0.005F, 0.008F), q - glm::vec2(-0.005F, 0.008F)) / 1.0e-5F);
      const float hollow = 1 - 0.28F * (1 - glm::smoothstep(-0.006F, 0.004F, dip));
      top = over(canvas.fill(well, rim), top);
      top = over(canvas.fill(linearFromSrgb(kPans[pan]) * wet * hollow + 0.22F * gloss,
                             boxDistance(q, {0.0138F, 0.0168F}, 0.003F)),
                 top);
    }
    return top;
  });
}

void paintCoin(DeskCanvas& canvas, const Placement& at, float radiusMetres, std::uint32_t srgb) {
  const glm::vec3 metal = linearFromSrgb(srgb);
  canvas.shadow(at, glm::vec2(radiusMetres), radiusMetres, 0.003F);
  canvas.paint(at, glm::vec2(radiusMetres + canvas.texelMetres()), [&](glm::vec2 p) {
    const float r = glm::length(p) / radiusMetres;
    const glm::vec2 towards = r > 0 ? p / (r * radiusMetres) : glm::vec2(0);
    const float facing = glm::dot(towards, glm::vec2(-0.62F, 0.78F));
    const float rim = glm::smoothstep(0.80F, 0.84F, r) - 2 * glm::smoothstep(0.92F, 1.0F, r);
    const float brushed = 0.10F * std::cos(3 * std::atan2(p.y, p.x) + 1.0F);
    const float relief = 0.25F * (valueNoise(420, p / radiusMetres * 4.0F) - 0.5F);
    const float light = 1 + brushed + (r < 0.8F ? relief : 0.0F) - 0.4F * rim * facing;
    return canvas.fill(metal * light, discDistance(p, radiusMetres));
  });
}

void paintWasher(DeskCanvas& canvas, const Placement& at, float radiusMetres) {
  const glm::vec3 steel = linearFromSrgb(0xb9bdc4);
  canvas.shadow(at, glm::vec2(radiusMetres), radiusMetres, 0.0025F);
  canvas.paint(at, glm::vec2(radiusMetres + canvas.texelMetres()), [&](glm::vec2 p) {
    const float angle = std::atan2(p.y, p.x);
    const float light = 0.95F + 0.28F * std::cos(2 * angle - 1.2F) + 0.08F * std::cos(7 * angle);
    const float ring = ringDistance(p, radiusMetres * 0.74F, radiusMetres * 0.52F);
    return canvas.fill(steel * light, ring);
  });
}

void paintCupRing(DeskCanvas& canvas, const Placement& at) {
  const glm::vec3 stain = linearFromSrgb(0x5a3014);
  canvas.paint(at, glm::vec2(0.048F), [&](glm::vec2 p) {
    const float angle = std::atan2(p.y, p.x);
    const float uneven = 0.5F + 0.5F * std::sin(angle + 0.6F) * std::sin(2 * angle);
    const float distance = std::abs(glm::length(p) - 0.041F) - 0.0006F - 0.0014F * uneven;
    return Paint{stain,
                 (0.16F + 0.22F * uneven) * (1 - glm::smoothstep(-0.001F, 0.0016F, distance))};
  });
}

void paintLeaf(DeskCanvas& canvas, const Placement& at, std::uint32_t srgb) {
  const glm::vec3 green = linearFromSrgb(srgb), vein = linearFromSrgb(0xd9d98c);
  canvas.shadow(at, {0.045F, 0.016F}, 0.016F, 0.004F);
  canvas.paint(at, {0.058F, 0.030F}, [&](glm::vec2 p) {
    const float t = glm::clamp((p.x + 0.045F) / 0.098F, 0.0F, 1.0F);
    const float width = 0.026F * std::sin(3.14159F * std::pow(t, 0.75F)) * (1 - 0.25F * t);
    const float side = std::abs(p.y);
    const float veins = std::abs(std::fmod(p.x - 0.8F * side + 1.0F, 0.012F) - 0.006F) - 0.0004F;
    const float light = (p.y > 0 ? 1.12F : 0.85F) + 0.2F * (valueNoise(430, p * 120.0F) - 0.5F);
    Paint top = canvas.fill(green * light, side - width);
    top = over(canvas.fill(vein, std::max(veins, side - width + 0.002F), 0.35F), top);
    const float stalk = strokeDistance(p, {-0.056F, 0}, {0.040F, 0}, 0.0014F);
    return over(canvas.fill(vein * 0.8F, stalk, 0.9F), top);
  });
}

}  // namespace pleinair::hal::synthetic
