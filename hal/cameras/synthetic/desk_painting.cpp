#include "hal/cameras/synthetic/desk_painting.h"

#include <array>
#include <cmath>

#include "hal/cameras/synthetic/desk_canvas.h"
#include "hal/cameras/synthetic/desk_papers.h"
#include "hal/cameras/synthetic/desk_tags.h"
#include "hal/cameras/synthetic/desk_tools.h"
#include "hal/cameras/synthetic/noise.h"
#include "hal/cameras/synthetic/row_threads.h"
#include "hal/cameras/synthetic/wood.h"

namespace pleinair::hal::synthetic {
namespace {

const glm::vec2 kCentre = glm::vec2(kDeskLow + kDeskHigh) / 2.0F;
const glm::vec2 kHalf = glm::vec2(kDeskHigh - kDeskLow) / 2.0F;

void paintWood(DeskCanvas& canvas, std::uint32_t seed) {
  canvas.paint({kCentre, 0}, kHalf + canvas.texelMetres(), [&](glm::vec2 p) {
    const float edge = boxDistance(p, kHalf, static_cast<float>(kDeskCornerRadius));
    const float rounded = 1 - 0.35F * glm::smoothstep(-0.006F, 0.0F, edge);
    return canvas.fill(woodLinearRgb(seed, p + kCentre) * rounded, edge);
  });
}

void paintBigThings(DeskCanvas& canvas, std::uint32_t seed) {
  paintCupRing(canvas, {{-0.10F, 0.40F}, 0});
  paintPoster(canvas, {{-0.34F, 0.13F}, 10});
  paintWrittenSheet(canvas, {{-0.045F, 0.255F}, -9}, seed);
  paintCuttingMat(canvas, {{0.155F, -0.045F}, -6});
  paintColourChart(canvas, {{0.30F, 0.375F}, 14});
  paintWrittenSheet(canvas, {{0.56F, -0.15F}, 17}, seed + 5);
  paintNotebook(canvas, {{0.64F, 0.30F}, -20}, 0x2a4d86);
  paintNotebook(canvas, {{-0.70F, -0.16F}, 33}, 0xb8472f);
  paintColourChart(canvas, {{-0.62F, 0.36F}, -22});
  paintPoster(canvas, {{0.10F, -0.47F}, 84});
}

void paintSmallThings(DeskCanvas& canvas) {
  paintStickyNote(canvas, {{0.215F, 0.235F}, 8}, 0xf7dc54);
  paintStickyNote(canvas, {{0.275F, 0.190F}, -12}, 0xf08a9b);
  paintRule(canvas, {{0.16F, -0.255F}, -3});
  paintPaintBox(canvas, {{-0.155F, -0.255F}, 6});
  constexpr std::array<std::uint32_t, 6> kPencils{0xd0342c, 0xe98a1f, 0xe9c52b,
                                                  0x3a9a4b, 0x2b6cc4, 0x7a3f9d};
  for (std::size_t i = 0; i < kPencils.size(); ++i) {
    const auto n = static_cast<float>(i);
    paintPencil(canvas, {{-0.225F + 0.0185F * n, -0.105F - 0.003F * n * (5 - n)}, 78.0F + 5.5F * n},
                kPencils[i]);
  }
  paintBrush(canvas, {{0.455F, 0.02F}, 63}, 0x2e86c9);
  paintBrush(canvas, {{0.495F, 0.01F}, 72}, 0xd93a2b);
  paintCoin(canvas, {{0.335F, 0.085F}, 20}, 0.0125F, 0xd7a84a);
  paintCoin(canvas, {{0.362F, 0.060F}, 130}, 0.0105F, 0xc07a4c);
  paintCoin(canvas, {{0.331F, 0.052F}, 60}, 0.0115F, 0xc9cbd0);
  paintWasher(canvas, {{-0.015F, -0.155F}, 0}, 0.012F);
  paintWasher(canvas, {{0.012F, -0.172F}, 0}, 0.009F);
  paintWasher(canvas, {{0.29F, -0.125F}, 0}, 0.014F);
  paintLeaf(canvas, {{-0.455F, -0.06F}, 145}, 0x6f9a3a);
  paintLeaf(canvas, {{-0.48F, -0.105F}, 205}, 0xc98a2e);
  paintStickyNote(canvas, {{-0.52F, -0.32F}, -15}, 0x8fd0c4);
}

/// How bright the desk is: a lamp's pool from the far left, and a window's panes across it.
glm::vec3 lightAt(glm::vec2 p) {
  const glm::vec2 fromLamp = p - glm::vec2(-0.15F, 0.20F);
  const float pool = std::exp(-glm::dot(fromLamp, fromLamp) / 0.55F);
  const glm::vec2 q(0.82F * p.x + 0.57F * p.y, -0.57F * p.x + 0.82F * p.y);
  const auto slot = [](float x, float centre, float half, float soft) {
    return 1 - glm::smoothstep(half - soft, half + soft, std::abs(x - centre));
  };
  const float panes = (slot(q.x, -0.20F, 0.16F, 0.035F) + slot(q.x, 0.19F, 0.16F, 0.035F)) *
                      slot(q.y, 0.05F, 0.44F, 0.06F) * (1 - 0.8F * slot(q.y, 0.06F, 0.016F, 0.02F));
  const float dapple = 0.10F * (fractalNoise(77, p * 5.0F, 2) - 0.5F);
  return (0.50F + 0.24F * pool + dapple) * glm::vec3(1.0F, 0.97F, 0.93F) +
         0.34F * panes * glm::vec3(1.0F, 0.94F, 0.80F);
}

void lightUp(MipTexture::Level& level, glm::vec2 origin, float texelMetres) {
  const auto width = static_cast<std::size_t>(level.width);
  forRows(0, level.height, [&](int firstRow, int endRow) {
    for (int y = firstRow; y < endRow; ++y) {
      for (int x = 0; x < level.width; ++x) {
        Texel& texel =
            level.texels[static_cast<std::size_t>(y) * width + static_cast<std::size_t>(x)];
        if (texel.coverage == 0) continue;
        const glm::vec2 centre(static_cast<float>(x) + 0.5F, static_cast<float>(y) + 0.5F);
        texel =
            packTexel(unpackTexel(texel) * glm::vec4(lightAt(origin + centre * texelMetres), 1));
      }
    }
  });
}

}  // namespace

DeskPicture paintDesk(std::uint32_t seed, double texelMetres) {
  constexpr double kMarginTexels = 64;  // transparent on every level, for what lies beyond
  const glm::dvec2 texels = (kDeskHigh - kDeskLow) / texelMetres + 2 * kMarginTexels;
  DeskPicture desk{MipTexture(static_cast<int>(texels.x) + 1, static_cast<int>(texels.y) + 1),
                   kDeskLow - kMarginTexels * texelMetres, texelMetres};
  const glm::vec2 origin(desk.originMetres);
  const auto texel = static_cast<float>(texelMetres);
  DeskCanvas canvas(desk.texture.base(), origin, texel);
  paintWood(canvas, seed);
  paintBigThings(canvas, seed);
  paintSmallThings(canvas);
  for (const DeskTag& tag : deskTags()) paintTagCard(canvas, tag);
  lightUp(desk.texture.base(), origin, texel);
  desk.texture.buildLevels();
  return desk;
}

}  // namespace pleinair::hal::synthetic
