#include "hal/cameras/synthetic/canvas.h"

namespace pleinair::hal::synthetic {
namespace {

/// Where the shadow of a point one metre above a lying surface falls: away from the window.
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

}  // namespace pleinair::hal::synthetic
