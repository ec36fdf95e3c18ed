#include <array>
#include <cmath>

#include "hal/cameras/synthetic/world/canvas.h"
#include "hal/cameras/synthetic/world/materials.h"
#include "hal/cameras/synthetic/world/papers.h"
#include "hal/cameras/synthetic/world/srgb.h"
#include "hal/cameras/synthetic/world/wood.h"
#include "hal/cameras/synthetic/world/workbench.h"

namespace pleinair::hal::synthetic {
namespace {

constexpr float kMiddleY = static_cast<float>((kBenchFront + kBenchBack) / 2);

/// A placement on the bench's top, in world coordinates.
Placement onTop(float x, float y, float degrees = 0) {
  return {{x, y - kMiddleY}, degrees};
}

void paintTop(Canvas& canvas, std::uint32_t seed) {
  Wood wood(seed);
  canvas.paintAllAlongX([&](glm::vec2 p) {
    const float edge = boxDistance(p, canvas.half());
    return wood.linearRgbAt(p) * (1 + 0.18F * glm::smoothstep(-0.006F, -0.001F, edge));
  });
  paintMugRing(canvas, onTop(0.22F, -0.32F));
  paintDrawing(canvas, onTop(-0.315F, -0.255F, 9));
  paintNotes(canvas, onTop(0.80F, -0.27F, -16), {0.074F, 0.105F}, 7);
  paintStickyNote(canvas, onTop(-0.125F, -0.155F, -7), 0xe3c65a);
  paintRule(canvas, onTop(0.01F, -0.375F, 4));
  paintWrench(canvas, onTop(0.27F, -0.235F, 62), 0.19F);
  paintScrewdriver(canvas, onTop(0.905F, -0.10F, 28), 0.21F, 0xc0492e);
  constexpr std::array<glm::vec3, 4> kWashers{{{0.205F, 0.165F, .011F},
                                               {0.231F, 0.150F, .008F},
                                               {0.17F, -0.19F, .009F},
                                               {0.41F, -0.13F, .011F}}};
  for (const glm::vec3& washer : kWashers) paintWasher(canvas, onTop(washer.x, washer.y), washer.z);
  paintTagCard(canvas, onTop(0, 0), benchTags()[0]);
}

/// The bench's front with two drawers.
void paintApron(Canvas& canvas) {
  board(0x9a6d42, 51)(canvas);
  const glm::vec2 half(0.46F, canvas.half().y - 0.022F);
  for (const float x : {-0.56F, 0.56F}) {
    canvas.paint({{x, 0}, 0}, half + 0.02F, [&](glm::vec2 p) {
      const float edge = boxDistance(p, half);
      const glm::vec3 gap = linearFromSrgb(0x3a2718);
      Paint top{gap, 0.9F * canvas.inside(std::abs(edge) - 0.0018F)};
      const float knob = discDistance(p, 0.016F);
      const float shadow = discDistance(p - glm::vec2(0.008F, -0.008F), 0.017F);
      top = over({gap, 0.5F * (1 - glm::smoothstep(-0.004F, 0.006F, shadow))}, top);
      const float light = 1.0F - 20.0F * (p.x - p.y);
      return over(canvas.fill(linearFromSrgb(0x7d6a4a) * light, knob), top);
    });
  }
}

}  // namespace

void buildBench(Builder& builder, std::uint32_t seed) {
  constexpr double kThickness = 0.052;
  const double middleY = (kBenchFront + kBenchBack) / 2;
  const double depth = kBenchBack - kBenchFront;
  const Painter edge = board(0xb07c4a, 52);
  builder.patchSettings() = {.coarseness = 1, .lightStep = 0.0065};
  builder.box(uprightPose({0, middleY, -kThickness}), {2 * kBenchHalfWidth, depth, kThickness},
              {.other = edge, .top = [seed](Canvas& canvas) { paintTop(canvas, seed); }});
  builder.patchSettings() = {.coarseness = 1.6, .lightStep = 0.02};
  builder.box(uprightPose({0, kBenchFront + 0.05, -kThickness - 0.13}), {2.1, 0.03, 0.13},
              {.other = edge, .front = paintApron});
  builder.patchSettings() = {.coarseness = 3, .lightStep = 0.03};
  for (const double x : {-1.02, 1.02}) {
    for (const double y : {kBenchFront + 0.085, kBenchBack - 0.08}) {
      builder.box(uprightPose({x, y, kFloorZ}), {0.09, 0.09, -kFloorZ - kThickness},
                  {.other = board(0x8f643c, 53, true)});
    }
  }
  builder.box(uprightPose({0, middleY + 0.02, kFloorZ + 0.16}), {2.02, 0.62, 0.03},
              {.other = board(0x7c5734, 54)});
}

}  // namespace pleinair::hal::synthetic
