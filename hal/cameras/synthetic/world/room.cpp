#include <array>
#include <cmath>

#include <glm/geometric.hpp>

#include "hal/cameras/synthetic/world/canvas.h"
#include "hal/cameras/synthetic/world/light.h"
#include "hal/cameras/synthetic/world/materials.h"
#include "hal/cameras/synthetic/world/noise.h"
#include "hal/cameras/synthetic/world/papers.h"
#include "hal/cameras/synthetic/world/srgb.h"
#include "hal/cameras/synthetic/world/workbench.h"

namespace pleinair::hal::synthetic {
namespace {

constexpr double kLeft = static_cast<double>(kWindowX);
constexpr double kRight = 2.7;
constexpr double kBehind = -3.4;
constexpr double kCeiling = 1.9;
constexpr glm::dvec3 kX{1, 0, 0};
constexpr glm::dvec3 kY{0, 1, 0};
constexpr glm::dvec3 kZ{0, 0, 1};

/// Plaster in a muted sage green that contrasts with the warm wood and the sun.
Painter plaster(std::uint32_t srgb) {
  const glm::vec3 colour = linearFromSrgb(srgb);
  return [colour](Canvas& canvas) {
    canvas.paintAll(
        [&](glm::vec2 p) { return colour * (0.95F + 0.10F * fractalNoise(61, p * 1.7F, 2)); });
  };
}

/// The view outside: a bright, hazy sky above far trees.
void paintSky(Canvas& canvas) {
  canvas.paintAll([&](glm::vec2 p) {
    const float up = p.y / canvas.half().y;
    const float trees = 0.10F + 0.35F * fractalNoise(62, {p.x * 5.0F, 1}, 3);
    const glm::vec3 sky = glm::mix(glm::vec3(0.93F, 0.93F, 0.88F), glm::vec3(0.70F, 0.83F, 0.95F),
                                   glm::smoothstep(-0.4F, 1.0F, up));
    const glm::vec3 leaves =
        glm::vec3(0.36F, 0.44F, 0.30F) * (0.9F + 0.5F * fractalNoise(63, p * 7.0F, 2));
    return glm::mix(sky, leaves, 1 - glm::smoothstep(trees - 0.95F, trees - 0.80F, up));
  });
}

void buildWindow(Builder& builder) {
  for (const Pane& pane : windowPanes()) {
    const glm::dvec2 middle = glm::dvec2(pane.lowYz + pane.highYz) / 2.0;
    const glm::dvec2 half = glm::dvec2(pane.highYz - pane.lowYz) / 2.0;
    builder.patchSettings() = {.coarseness = 4, .lightStep = 0.1, .isEmissive = true};
    builder.panel({kLeft + 0.004, middle.x, middle.y}, kY, kZ, half, paintSky);
  }
  // The frame's bars, between and around the panes.
  builder.patchSettings() = {.coarseness = 3, .lightStep = 0.03};
  const Painter paint = plain(0xd6d3c6);
  for (const double y : {-1.14, -0.63, -0.12}) {
    builder.panel({kLeft + 0.012, y, 0.95}, kY, kZ, {y == -0.63 ? 0.03 : 0.04, 0.57}, paint);
  }
  for (const double z : {0.38, 0.95, 1.52}) {
    builder.panel({kLeft + 0.011, -0.63, z}, kY, kZ, {0.55, z == 0.95 ? 0.03 : 0.04}, paint);
  }
  builder.box(uprightPose({kLeft + 0.07, -0.63, 0.315}), {0.14, 1.2, 0.03}, {.other = paint});
}

void paintPegboard(Canvas& canvas) {
  const glm::vec3 hole = linearFromSrgb(0x6a5f48);
  enamel(0xc9bb98)(canvas);
  canvas.paint({}, canvas.half() - 0.02F, [&](glm::vec2 p) {
    const glm::vec2 cell = p - 0.05F * glm::round(p / 0.05F);
    return canvas.fill(hole, discDistance(cell, 0.0036F), 0.7F);
  });
  paintSaw(canvas, {{-0.13F, 0.205F}, 0});
  paintHammer(canvas, {{-0.345F, 0.06F}, 4});
  float x = -0.235F;
  for (const float length : {0.215F, 0.190F, 0.168F, 0.148F}) {
    paintWrench(canvas, {{x, 0.120F - length / 2}, 0}, length);
    x += 0.055F;
  }
  paintPliers(canvas, {{0.030F, 0.040F}, 0}, 0xb8452c);
  paintPliers(canvas, {{0.108F, 0.040F}, 0}, 0x35617f);
  constexpr std::array<std::uint32_t, 4> kGrips{0xd09a33, 0xb8452c, 0x35617f, 0xd09a33};
  float length = 0.205F;
  x = 0.172F;
  for (const std::uint32_t grip : kGrips) {
    paintScrewdriver(canvas, {{x, 0.125F - length / 2}, 0}, length, grip);
    x += 0.048F;
    length -= 0.018F;
  }
  paintSquare(canvas, {{0.255F, 0.215F}, 0});
}

void buildWall(Builder& builder) {
  // The part of the wall behind the bench has finer textures than the parts above and beside it.
  const Painter sage = plaster(0xb7bcab);
  constexpr double kFineLeft = -1.35;
  constexpr double kFineRight = 1.45;
  constexpr double kFineTop = 1.15;
  const auto wall = [&](double left, double right, double low, double high) {
    builder.panel({(left + right) / 2, kWallY, (low + high) / 2}, kX, kZ,
                  {(right - left) / 2, (high - low) / 2}, sage);
  };
  builder.patchSettings() = {.coarseness = 3, .lightStep = 0.014};
  wall(kFineLeft, kFineRight, -0.05, kFineTop);
  builder.patchSettings() = {.coarseness = 8, .lightStep = 0.06};
  wall(kLeft, kFineLeft, kFloorZ, kCeiling);
  wall(kFineRight, kRight, kFloorZ, kCeiling);
  wall(kFineLeft, kFineRight, kFineTop, kCeiling);
  wall(kFineLeft, kFineRight, kFloorZ, -0.05);

  builder.patchSettings() = {.coarseness = 1.35, .lightStep = 0.012};
  builder.box(uprightPose({0.58, kWallY - 0.008, 0.19}), {0.84, 0.016, 0.56},
              {.other = plain(0xa8986f), .front = paintPegboard});
  builder.patchSettings() = {.coarseness = 1.35, .lightStep = 0.02};
  builder.panel({-0.56, kWallY - 0.002, 0.50}, kX, kZ, {0.155, 0.212}, paintPoster);
  builder.panel(kWallSheetCentre, kX, kZ, {0.078, 0.108}, [](Canvas& canvas) {
    plain(0xe6e1d2)(canvas);
    paintTagCard(canvas, {{0, -0.02F}, 0}, benchTags()[3]);
    canvas.paint({}, canvas.half(), [&](glm::vec2 p) {
      const float title = boxDistance(p - glm::vec2(0, 0.078F), {0.050F, 0.006F});
      return canvas.fill(linearFromSrgb(0x3b4a58), title, 0.8F);
    });
  });
  builder.panel({-0.345, kWallY - 0.003, 0.33}, kX, kZ, {0.038, 0.038},
                [](Canvas& canvas) { paintStickyNote(canvas, {}, 0xd98b62); });
}

void buildShelf(Builder& builder) {
  builder.patchSettings() = {.coarseness = 1.5, .lightStep = 0.012};
  builder.box(uprightPose({-0.56, 0.355, 0.80}), {0.86, 0.19, 0.024},
              {.other = board(0xa87a4b, 71), .bottom = board(0xa87a4b, 72)});
  constexpr std::array<std::uint32_t, 3> kTins{0x8f3a2a, 0xc7bd9f, 0x3e6a72};
  double x = -0.88;
  for (const std::uint32_t tin : kTins) {
    builder.cylinder(uprightPose({x, 0.36, 0.824}), {0.045, 0.045, 0.12, 20},
                     ringed(tin, 0xe3d8bb, 0.09F, 0.55F), plain(0x9a9a94));
    x += 0.115;
  }
  builder.box(uprightPose({-0.42, 0.36, 0.824}, 4), {0.22, 0.14, 0.12}, {.other = cardboard()});
  builder.box(uprightPose({-0.22, 0.36, 0.824}), {0.045, 0.13, 0.20}, {.other = enamel(0x35566b)});
}

}  // namespace

void buildRoom(Builder& builder) {
  constexpr double kMiddleX = (kLeft + kRight) / 2;
  constexpr double kMiddleY = (kWallY + kBehind) / 2;
  constexpr double kMiddleZ = (kFloorZ + kCeiling) / 2;
  constexpr double kHalfX = (kRight - kLeft) / 2;
  constexpr double kHalfY = (kWallY - kBehind) / 2;
  constexpr double kHalfZ = (kCeiling - kFloorZ) / 2;
  builder.patchSettings() = {.coarseness = 10, .lightStep = 0.06};
  builder.panel({kMiddleX, kMiddleY, kFloorZ}, kX, kY, {kHalfX, kHalfY}, board(0x8a7660, 64));
  builder.panel({kMiddleX, kMiddleY, kCeiling}, kX, -kY, {kHalfX, kHalfY}, plain(0xc9c7bd));
  builder.panel({kLeft, kMiddleY, kMiddleZ}, kY, kZ, {kHalfY, kHalfZ}, plain(0x9ba193));
  builder.panel({kRight, kMiddleY, kMiddleZ}, -kY, kZ, {kHalfY, kHalfZ}, plain(0x9ba193));
  builder.panel({kMiddleX, kBehind, kMiddleZ}, -kX, kZ, {kHalfX, kHalfZ}, plain(0x9ba193));
  buildWindow(builder);
  buildWall(builder);
  buildShelf(builder);
}

}  // namespace pleinair::hal::synthetic
