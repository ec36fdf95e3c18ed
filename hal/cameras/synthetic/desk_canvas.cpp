#include "hal/cameras/synthetic/desk_canvas.h"

#include <glm/vec4.hpp>

namespace pleinair::hal::synthetic {
namespace {

/// Where the shadow of a point one metre high falls.
constexpr glm::vec2 kShadowOfHeight{0.75F, -0.95F};

}  // namespace

void DeskCanvas::shadow(const Placement& at, glm::vec2 half, float cornerRadius,
                        float heightMetres) {
  const float blur = 0.004F + 1.6F * heightMetres;
  Placement fallen = at;
  fallen.centreMetres += kShadowOfHeight * heightMetres;
  paint(fallen, half + blur, [&](glm::vec2 p) {
    const float distance = boxDistance(p, half, cornerRadius);
    return Paint{glm::vec3(0.02F, 0.012F, 0.008F),
                 0.55F * (1 - glm::smoothstep(-blur, blur, distance))};
  });
}

void DeskCanvas::blend(int x, int y, const Paint& paint) {
  if (paint.coverage <= 0) return;
  Texel& texel =
      level_.texels[static_cast<std::size_t>(y) * static_cast<std::size_t>(level_.width) +
                    static_cast<std::size_t>(x)];
  const glm::vec4 below = unpackTexel(texel);
  texel =
      packTexel(glm::vec4(paint.linearRgb, 1.0F) * paint.coverage + below * (1 - paint.coverage));
}

}  // namespace pleinair::hal::synthetic
