#include "hal/cameras/synthetic/world/canvas.h"

#include <cmath>

#include "hal/cameras/synthetic/world/srgb.h"

namespace pleinair::hal::synthetic {
namespace {

/// Offset of the shadow of a point one metre above a horizontal surface: away from the window.
constexpr glm::vec2 kShadowOfHeight{1.1F, 0.35F};

}  // namespace

void Canvas::shadow(const Placement& at, glm::vec2 half, float cornerRadius, float heightMetres) {
  const float blur = 0.003F + 1.3F * heightMetres;
  Placement fallen = at;
  fallen.centreMetres += kShadowOfHeight * heightMetres;
  paint(fallen, half + blur, [&](glm::vec2 p) {
    const float distance = boxDistance(p, half, cornerRadius);
    return Paint{glm::vec3(0.02F, 0.012F, 0.010F),
                 0.5F * (1 - glm::smoothstep(-blur, blur, distance))};
  });
}

void Canvas::blend(int x, int y, const Paint& paint) {
  if (paint.coverage <= 0) return;
  Texel& texel =
      level_.texels[static_cast<std::size_t>(y) * static_cast<std::size_t>(level_.width) +
                    static_cast<std::size_t>(x)];
  const glm::vec3 below = paint.coverage >= 1 ? glm::vec3(0) : linearRgbOf(texel);
  texel = codedTexel(paint.linearRgb * paint.coverage + below * (1 - paint.coverage));
}

namespace {

/// Brightness across a round object, lit from its left.
float roundLight(float acrossOverRadius) {
  const float gloss = std::exp(-(acrossOverRadius + 0.35F) * (acrossOverRadius + 0.35F) * 14);
  return 0.80F - 0.30F * acrossOverRadius + 0.45F * gloss;
}

/// Paints the shadow of a shape from its distance function, blurred and shifted.
template <class Distance>
void paintShadowOf(Canvas& canvas, Placement at, glm::vec2 half, const Distance& distance) {
  at.centreMetres += glm::vec2(0.007F, -0.006F);
  canvas.paint(at, half + 0.012F, [&](glm::vec2 p) {
    return Paint{glm::vec3(0.02F, 0.015F, 0.012F),
                 0.42F * (1 - glm::smoothstep(-0.005F, 0.007F, distance(p)))};
  });
}

}  // namespace

void paintWrench(Canvas& canvas, const Placement& at, float lengthMetres) {
  const glm::vec3 chrome = linearFromSrgb(0xa9aeb0);
  const float end = lengthMetres / 2;
  const float head = 0.105F * lengthMetres;
  const auto shape = [=](glm::vec2 p) {
    const float shank = boxDistance(p, {0.042F * lengthMetres, end - head}, 0.004F);
    const float open = std::max(discDistance(p - glm::vec2(0, end - head), head),
                                -boxDistance(p - glm::vec2(0, end), {0.48F * head, 0.95F * head}));
    const float ring = std::max(discDistance(p + glm::vec2(0, end - 0.8F * head), 0.8F * head),
                                -discDistance(p + glm::vec2(0, end - 0.8F * head), 0.46F * head));
    return std::min({shank, open, ring});
  };
  const glm::vec2 half(1.2F * head, end + 0.004F);
  paintShadowOf(canvas, at, half, shape);
  canvas.paint(at, half, [&](glm::vec2 p) {
    const float distance = shape(p);
    const float bevel = glm::smoothstep(-0.003F, 0.0F, distance);
    const float groove = boxDistance(p, {0.018F * lengthMetres, 0.5F * end}, 0.003F);
    const float light = 0.95F - 0.25F * p.x / head - 0.25F * bevel - 0.18F * canvas.inside(groove);
    return canvas.fill(chrome * light, distance);
  });
}

void paintScrewdriver(Canvas& canvas, const Placement& at, float lengthMetres, std::uint32_t srgb) {
  const glm::vec3 grip = linearFromSrgb(srgb), metal = linearFromSrgb(0xaaaeb0);
  const float end = lengthMetres / 2;
  const float gripLength = 0.42F * lengthMetres;
  const auto gripShape = [=](glm::vec2 p) {
    const glm::vec2 q = p - glm::vec2(0, end - gripLength / 2);
    const float waist = 1 - 0.16F * std::cos(q.y / gripLength * 9.0F);
    return boxDistance({q.x / waist, q.y}, {0.0125F, gripLength / 2}, 0.010F);
  };
  const auto blade = [=](glm::vec2 p) {
    return boxDistance(p + glm::vec2(0, gripLength / 2), {0.0032F, end - gripLength / 2});
  };
  const auto shape = [&](glm::vec2 p) { return std::min(gripShape(p), blade(p)); };
  const glm::vec2 half(0.018F, end + 0.003F);
  paintShadowOf(canvas, at, half, shape);
  canvas.paint(at, half, [&](glm::vec2 p) {
    const Paint below = canvas.fill(metal * roundLight(p.x / 0.0032F), blade(p));
    return over(canvas.fill(grip * roundLight(p.x / 0.0125F), gripShape(p)), below);
  });
}

void paintPliers(Canvas& canvas, const Placement& at, std::uint32_t srgb) {
  const glm::vec3 grip = linearFromSrgb(srgb), metal = linearFromSrgb(0x84898c);
  const auto leg = [](glm::vec2 p) {
    const glm::vec2 q(std::abs(p.x), p.y);
    return std::min(strokeDistance(q, {0.006F, 0.012F}, {0.022F, -0.035F}, 0.013F),
                    strokeDistance(q, {0.022F, -0.035F}, {0.020F, -0.095F}, 0.013F));
  };
  const auto jaws = [](glm::vec2 p) {
    const float taper = 0.015F - 0.10F * std::max(0.0F, p.y - 0.030F);
    return std::max(std::abs(p.x) - taper, std::abs(p.y - 0.045F) - 0.040F);
  };
  const auto shape = [&](glm::vec2 p) { return std::min(leg(p), jaws(p)); };
  const glm::vec2 half(0.034F, 0.105F);
  paintShadowOf(canvas, at, half, shape);
  canvas.paint(at, half, [&](glm::vec2 p) {
    const float light = 1.0F - 6.0F * p.x;
    const glm::vec3 legs = p.y < -0.022F ? grip : metal;
    Paint top = canvas.fill(legs * light, leg(p));
    top = over(canvas.fill(metal * (1.1F * light), jaws(p)), top);
    top = over(canvas.fill(metal * 0.35F, std::abs(p.x) - 0.0008F, p.y > 0.02F ? top.coverage : 0),
               top);
    return over(
        canvas.fill(metal * 0.55F, ringDistance(p - glm::vec2(0, 0.014F), 0.0065F, 0.0018F)), top);
  });
}

void paintHammer(Canvas& canvas, const Placement& at) {
  const glm::vec3 ash = linearFromSrgb(0xb98a54), metal = linearFromSrgb(0x5d6468);
  const auto handle = [](glm::vec2 p) {
    const float swell = 0.0125F + 0.0035F * glm::smoothstep(-0.02F, -0.13F, p.y);
    return boxDistance({p.x * 0.0125F / swell, p.y + 0.012F}, {0.0125F, 0.140F}, 0.006F);
  };
  const auto head = [](glm::vec2 p) {
    const glm::vec2 q = p - glm::vec2(0, 0.128F);
    const float face = boxDistance(q + glm::vec2(0.034F, 0), {0.020F, 0.019F}, 0.003F);
    const float neck = boxDistance(q, {0.050F, 0.012F}, 0.002F);
    const float claw = triangleDistance(q, {0.020F, -0.012F}, {0.070F, -0.026F}, {0.020F, 0.012F});
    return std::min({face, neck, claw});
  };
  const auto shape = [&](glm::vec2 p) { return std::min(handle(p), head(p)); };
  const glm::vec2 half(0.080F, 0.160F);
  paintShadowOf(canvas, at, half, shape);
  canvas.paint(at, half, [&](glm::vec2 p) {
    const Paint below = canvas.fill(ash * roundLight(p.x / 0.0145F), handle(p));
    return over(canvas.fill(metal * (1.0F + 14.0F * (p.y - 0.126F)), head(p)), below);
  });
}

void paintSaw(Canvas& canvas, const Placement& at) {
  const glm::vec3 blade = linearFromSrgb(0xa7abab), brass = linearFromSrgb(0xa98645),
                  grip = linearFromSrgb(0x8a5730);
  const auto bladeShape = [](glm::vec2 p) {
    return boxDistance(p - glm::vec2(0.040F, -0.004F), {0.130F, 0.036F});
  };
  const auto gripShape = [](glm::vec2 p) {
    const glm::vec2 q = p + glm::vec2(0.120F, 0.004F);
    return std::max(boxDistance(q, {0.042F, 0.050F}, 0.022F),
                    -boxDistance(q + glm::vec2(0.004F, 0.002F), {0.014F, 0.026F}, 0.012F));
  };
  const auto shape = [&](glm::vec2 p) { return std::min(bladeShape(p), gripShape(p)); };
  const glm::vec2 half(0.175F, 0.060F);
  paintShadowOf(canvas, at, half, shape);
  canvas.paint(at, half, [&](glm::vec2 p) {
    Paint top = canvas.fill(blade * (0.95F + 1.3F * p.x), bladeShape(p));
    top =
        over(canvas.fill(brass, boxDistance(p - glm::vec2(0.040F, 0.030F), {0.130F, 0.006F})), top);
    return over(canvas.fill(grip * (0.95F + 3.0F * p.y), gripShape(p)), top);
  });
}

void paintSquare(Canvas& canvas, const Placement& at) {
  const glm::vec3 blade = linearFromSrgb(0xb3b6b2), stock = linearFromSrgb(0x6d3f24);
  const auto bladeShape = [](glm::vec2 p) {
    return boxDistance(p - glm::vec2(0, -0.055F), {0.120F, 0.017F});
  };
  const auto stockShape = [](glm::vec2 p) {
    return boxDistance(p - glm::vec2(-0.103F, 0.010F), {0.017F, 0.082F});
  };
  const auto shape = [&](glm::vec2 p) { return std::min(bladeShape(p), stockShape(p)); };
  const glm::vec2 half(0.130F, 0.100F);
  paintShadowOf(canvas, at, half, shape);
  canvas.paint(at, half, [&](glm::vec2 p) {
    return over(canvas.fill(stock, stockShape(p)),
                canvas.fill(blade * (0.95F - p.x), bladeShape(p)));
  });
}

void paintRule(Canvas& canvas, const Placement& at) {
  const glm::vec2 half(0.155F, 0.0135F);
  const glm::vec3 metal = linearFromSrgb(0xbcbfbd), ink = linearFromSrgb(0x33363a);
  canvas.shadow(at, half, 0.001F, 0.0014F);
  canvas.paint(at, half + canvas.texelMetres(), [&](glm::vec2 p) {
    const float gloss = 0.90F + 0.20F * std::cos(9.0F * p.x + 0.6F);
    Paint top = canvas.fill(metal * gloss, boxDistance(p, half, 0.001F));
    const float tick = std::round(p.x / 0.005F);
    const bool isCentimetre = std::fmod(std::abs(tick), 2.0F) < 0.5F;
    const float fromTick = std::abs(p.x - tick * 0.005F) - 0.0004F;
    const float below = half.y - (isCentimetre ? 0.010F : 0.006F) - p.y;
    return over(canvas.fill(ink, std::max({fromTick, below, std::abs(p.x) - 0.1505F}), 0.8F), top);
  });
}

void paintWasher(Canvas& canvas, const Placement& at, float radiusMetres) {
  const glm::vec3 metal = linearFromSrgb(0xb0b3b4);
  canvas.shadow(at, glm::vec2(radiusMetres), radiusMetres, 0.0018F);
  canvas.paint(at, glm::vec2(radiusMetres + canvas.texelMetres()), [&](glm::vec2 p) {
    const float light = 0.95F + 0.25F * std::cos(2 * std::atan2(p.y, p.x) - 1.2F);
    return canvas.fill(metal * light, ringDistance(p, radiusMetres * 0.74F, radiusMetres * 0.52F));
  });
}

}  // namespace pleinair::hal::synthetic
