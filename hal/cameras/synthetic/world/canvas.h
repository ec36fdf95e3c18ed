#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "hal/cameras/synthetic/world/mip_texture.h"

namespace pleinair::hal::synthetic {

/// Position of an object on a canvas; the object's x axis is turned counter-clockwise by the angle.
struct Placement {
  glm::vec2 centreMetres{0};
  float angleDegrees = 0;
};

/// A colour with opacity, painted over the existing one.
struct Paint {
  glm::vec3 linearRgb{0};
  float coverage = 0;
};

/// Composites `top` over `bottom`.
inline Paint over(Paint top, Paint bottom) {
  const float rest = bottom.coverage * (1 - top.coverage);
  const float coverage = top.coverage + rest;
  if (coverage <= 0) return {};
  return {(top.linearRgb * top.coverage + bottom.linearRgb * rest) / coverage, coverage};
}

/// Signed distances in metres, negative inside.
inline float boxDistance(glm::vec2 p, glm::vec2 half, float cornerRadius = 0) {
  const glm::vec2 d = glm::abs(p) - half + cornerRadius;
  return glm::length(glm::max(d, 0.0F)) + std::min(std::max(d.x, d.y), 0.0F) - cornerRadius;
}
inline float discDistance(glm::vec2 p, float radius) {
  return glm::length(p) - radius;
}
inline float ringDistance(glm::vec2 p, float radius, float width) {
  return std::abs(glm::length(p) - radius) - width / 2;
}
inline float strokeDistance(glm::vec2 p, glm::vec2 from, glm::vec2 to, float width) {
  const glm::vec2 along = to - from;
  const float t = glm::clamp(glm::dot(p - from, along) / glm::dot(along, along), 0.0F, 1.0F);
  return glm::length(p - from - along * t) - width / 2;
}
/// Distance to a convex triangle with counter-clockwise corners; exact along its sides.
inline float triangleDistance(glm::vec2 p, glm::vec2 a, glm::vec2 b, glm::vec2 c) {
  const auto side = [p](glm::vec2 from, glm::vec2 to) {
    const glm::vec2 along = glm::normalize(to - from);
    return glm::dot(p - from, glm::vec2(along.y, -along.x));
  };
  return std::max({side(a, b), side(b, c), side(c, a)});
}

/// A flat surface on which shapes are painted one over the other, in metres: seen from its front, x
/// runs to the right and y up. Row 0 of the texture is at the smallest y.
class Canvas {
 public:
  /// Paints on `level`; the outer corner of its first texel is at −`half`. Keeps a reference.
  Canvas(MipTexture::Level& level, glm::vec2 half, float texelMetres)
      : level_(level), half_(half), texel_(texelMetres) {}

  float texelMetres() const { return texel_; }
  /// The surface spans ±half() around the origin.
  glm::vec2 half() const { return half_; }

  /// The share of a texel inside a shape, from the texel centre's distance to the shape.
  float inside(float distanceMetres) const {
    return glm::clamp(0.5F - distanceMetres / texel_, 0.0F, 1.0F);
  }
  Paint fill(glm::vec3 linearRgb, float distanceMetres, float opacity = 1) const {
    return {linearRgb, inside(distanceMetres) * opacity};
  }

  /// Fills the whole surface with shade(point) → linear RGB.
  template <class Shade>
  void paintAll(const Shade& shade) {
    paint({}, half_ + 2 * texel_, [&](glm::vec2 p) { return Paint{shade(p), 1}; });
  }

  /// The same for shades that change slowly along x, such as wood grain: shade() is called for
  /// every fourth texel of a row, and the texels between are interpolated.
  template <class Shade>
  void paintAllAlongX(const Shade& shade) {
    constexpr int kStep = 4;
    const auto at = [&](int x, int y) {
      const glm::vec2 centre(static_cast<float>(x) + 0.5F, static_cast<float>(y) + 0.5F);
      return shade(centre * texel_ - half_);
    };
    for (int y = 0; y < level_.height; ++y) {
      Texel* row = level_.texels.data() + std::ptrdiff_t{y} * level_.width;
      glm::vec3 from = at(0, y);
      for (int x = 0; x < level_.width; x += kStep) {
        const glm::vec3 to = at(x + kStep, y);
        const int count = std::min(kStep, level_.width - x);
        for (int i = 0; i < count; ++i) {
          row[x + i] = codedTexel(glm::mix(from, to, static_cast<float>(i) / kStep));
        }
        from = to;
      }
    }
  }

  /// Paints `shade(point) → Paint` over every texel within ±`half` (metres) of an object; `point`
  /// is in the object's own coordinates, metres.
  template <class Shade>
  void paint(const Placement& at, glm::vec2 half, const Shade& shade) {
    const float angle = at.angleDegrees * 0.017453293F;
    const glm::vec2 xAxis(std::cos(angle), std::sin(angle));
    const glm::vec2 reach(std::abs(xAxis.x) * half.x + std::abs(xAxis.y) * half.y,
                          std::abs(xAxis.y) * half.x + std::abs(xAxis.x) * half.y);
    const glm::vec2 low = (at.centreMetres - reach + half_) / texel_;
    const glm::vec2 high = (at.centreMetres + reach + half_) / texel_;
    const int endX = std::min(level_.width, static_cast<int>(high.x) + 1);
    const int endY = std::min(level_.height, static_cast<int>(high.y) + 1);
    const int firstX = std::max(0, static_cast<int>(low.x));
    for (int y = std::max(0, static_cast<int>(low.y)); y < endY; ++y) {
      for (int x = firstX; x < endX; ++x) {
        const glm::vec2 centre(static_cast<float>(x) + 0.5F, static_cast<float>(y) + 0.5F);
        const glm::vec2 offset = centre * texel_ - half_ - at.centreMetres;
        const glm::vec2 point(glm::dot(offset, xAxis), xAxis.x * offset.y - xAxis.y * offset.x);
        if (std::abs(point.x) <= half.x && std::abs(point.y) <= half.y) blend(x, y, shade(point));
      }
    }
  }

  /// The soft shadow of a thin rounded box that lies `heightMetres` high, lit from the left.
  void shadow(const Placement& at, glm::vec2 half, float cornerRadius, float heightMetres);

 private:
  void blend(int x, int y, const Paint& paint);

  MipTexture::Level& level_;
  glm::vec2 half_;
  float texel_;
};

// Tools that lie or hang flat, with their shadows. Unless stated otherwise they hang, with their
// heads towards +y.

/// A combination wrench, open end up.
void paintWrench(Canvas& canvas, const Placement& at, float lengthMetres);
/// A screwdriver, point down.
void paintScrewdriver(Canvas& canvas, const Placement& at, float lengthMetres, std::uint32_t srgb);
/// Pliers, closed, jaws up.
void paintPliers(Canvas& canvas, const Placement& at, std::uint32_t srgb);
/// A claw hammer, head up, 0.30 m.
void paintHammer(Canvas& canvas, const Placement& at);
/// A tenon saw, 0.34 m along x, its teeth down.
void paintSaw(Canvas& canvas, const Placement& at);
/// A carpenter's square: 0.24 m along x, 0.15 m along y.
void paintSquare(Canvas& canvas, const Placement& at);
/// A steel rule, 0.31 m along x.
void paintRule(Canvas& canvas, const Placement& at);
/// A steel washer.
void paintWasher(Canvas& canvas, const Placement& at, float radiusMetres);

}  // namespace pleinair::hal::synthetic
