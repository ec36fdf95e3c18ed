#include <array>

#include <glm/geometric.hpp>

#include "hal/cameras/synthetic/world/materials.h"
#include "hal/cameras/synthetic/world/noise.h"
#include "hal/cameras/synthetic/world/papers.h"
#include "hal/cameras/synthetic/world/srgb.h"
#include "hal/cameras/synthetic/world/workbench.h"

namespace pleinair::hal::synthetic {
namespace {

void buildMug(Builder& builder) {
  const glm::dvec3 at(0.275, 0.035, 0);
  const glm::dmat4 pose = uprightPose(at, 0);
  builder.patchSettings() = {.coarseness = 0.9, .lightStep = 0.005};
  const Painter glaze = [](Canvas& canvas) {
    plain(0xe2dccb)(canvas);
    canvas.paint({}, canvas.half(), [&](glm::vec2 p) {
      const float rim = canvas.half().y - 0.007F - p.y;
      return canvas.fill(linearFromSrgb(0x2f5a7a), rim);
    });
  };
  builder.cylinder(pose, {0.038, 0.041, 0.088, 32}, glaze);
  builder.hollow(uprightPose(at + glm::dvec3(0, 0, 0.062)), {0.036, 0.0375, 0.026, 32},
                 plain(0xe6e1d4));
  builder.panel(at + glm::dvec3(0, 0, 0.0625), {1, 0, 0}, {0, 1, 0}, {0.0275, 0.0275},
                plain(0x3a2012));
  // The handle and the rim: two half rings of boxes would show their joints.
  std::array<glm::dvec3, 5> handle{{{0.038, 0, 0.072},
                                    {0.058, 0, 0.070},
                                    {0.067, 0, 0.048},
                                    {0.058, 0, 0.026},
                                    {0.038, 0, 0.020}}};
  const glm::dmat4 turned = uprightPose(at, -28);
  for (std::size_t i = 0; i + 1 < handle.size(); ++i) {
    const auto point = [&](std::size_t k) { return glm::dvec3(turned * glm::dvec4(handle[k], 1)); };
    const glm::dvec3 over = 0.06 * (point(i + 1) - point(i));
    builder.rod(point(i) - over, point(i + 1) + over, 0.0058, 0.0058, 10, plain(0xe2dccb));
  }
}

void buildBooks(Builder& builder) {
  builder.patchSettings() = {.coarseness = 1, .lightStep = 0.008};
  const Painter pages = ringed(0xe4dcc4, 0xcfc5a8, 0.0032F, 0.6F);
  const Painter blue = enamel(0x35566b);
  builder.box(kBooksPose * uprightPose({0, 0, 0}, 5), {0.25, 0.18, 0.030},
              {.other = pages, .top = blue, .left = blue});
  const Painter ochre = enamel(0xc9973c);
  const Painter cover =
      layered(ochre, [](Canvas& canvas) { paintTagCard(canvas, {}, benchTags()[4]); });
  builder.box(kBooksPose * uprightPose({0, 0, 0.030}), {0.215, 0.152, kBooksHeight - 0.030},
              {.other = pages, .top = cover, .left = ochre});
}

/// A heap of small parts, painted as dots of one colour.
Painter heapOf(std::uint32_t srgb) {
  const glm::vec3 colour = linearFromSrgb(srgb);
  return [colour](Canvas& canvas) {
    canvas.paintAll([&](glm::vec2 p) {
      const glm::vec2 cell = p / 0.014F;
      const float lump = valueNoise(81, cell);
      return colour * (0.40F + 0.75F * glm::smoothstep(0.25F, 0.75F, lump));
    });
  };
}

void buildBins(Builder& builder) {
  struct Bin {
    double x;
    std::uint32_t colour, parts;
  };
  constexpr std::array<Bin, 3> kBins{
      {{0.545, 0xcf9d38, 0x8f9496}, {0.685, 0x3f6b86, 0xa8863f}, {0.825, 0xb0503a, 0x6e7476}}};
  constexpr double kWidth = 0.128;
  constexpr double kDepth = 0.17;
  constexpr double kHeight = 0.092;
  constexpr double kWall = 0.004;
  builder.patchSettings() = {.coarseness = 1.1, .lightStep = 0.008};
  for (const Bin& bin : kBins) {
    const glm::dmat4 pose = uprightPose({bin.x, 0.325, 0}, 1.5);
    const Painter colour = plain(bin.colour);
    const Builder::BoxFaces faces{.other = colour};
    const double side = (kWidth - kWall) / 2;
    const double end = (kDepth - kWall) / 2;
    builder.box(pose * uprightPose({-side, 0, 0}), {kWall, kDepth, kHeight}, faces);
    builder.box(pose * uprightPose({side, 0, 0}), {kWall, kDepth, kHeight}, faces);
    builder.box(pose * uprightPose({0, end, 0}), {kWidth - 2 * kWall, kWall, kHeight}, faces);
    builder.box(pose * uprightPose({0, -end, 0}), {kWidth - 2 * kWall, kWall, 0.5 * kHeight},
                {.other = colour,
                 .front = layered(colour, [](Canvas& canvas) {
                   canvas.paint({}, canvas.half(), [&](glm::vec2 p) {
                     return canvas.fill(linearFromSrgb(0xe6dfca), boxDistance(p, {0.036F, 0.013F}));
                   });
                 })});
    builder.box(pose * uprightPose({0, 0, 0}), {kWidth - 2 * kWall, kDepth - 2 * kWall, 0.036},
                {.other = heapOf(bin.parts)});
  }
}

void buildOilCan(Builder& builder) {
  const glm::dvec3 at(-0.205, 0.235, 0);
  builder.patchSettings() = {.coarseness = 1, .lightStep = 0.006};
  builder.cylinder(uprightPose(at), {0.040, 0.040, 0.062, 28}, polished(0x6b7b5e), plain(0x77856a));
  builder.cylinder(uprightPose(at + glm::dvec3(0, 0, 0.062)), {0.039, 0.007, 0.042, 28},
                   polished(0x77876a), plain(0x77856a));
  builder.rod(at + glm::dvec3(0, 0, 0.100), at + glm::dvec3(-0.055, -0.018, 0.185), 0.0055, 0.0025,
              10, polished(0xa8894a));
}

void buildHexNut(Builder& builder, glm::dvec3 at, double degrees) {
  builder.cylinder(uprightPose(at, degrees), {0.012, 0.012, 0.010, 6}, plain(0x8d9294),
                   [](Canvas& canvas) {
                     plain(0xa5aaab)(canvas);
                     canvas.paint({}, canvas.half(), [&](glm::vec2 p) {
                       return canvas.fill(linearFromSrgb(0x2c2a28), discDistance(p, 0.0058F));
                     });
                   });
}

void buildSmallThings(Builder& builder) {
  builder.patchSettings() = {.coarseness = 1, .lightStep = 0.005};
  buildHexNut(builder, {0.175, -0.155, 0}, 10);
  buildHexNut(builder, {0.205, -0.135, 0}, 32);
  buildHexNut(builder, {0.305, -0.115, 0}, 5);
  // A pencil on the drawing, and a screwdriver.
  builder.rod({-0.345, -0.335, 0.0036}, {-0.195, -0.245, 0.0036}, 0.0036, 0.0036, 6,
              plain(0xc98f2e));
  builder.rod({-0.195, -0.245, 0.0036}, {-0.183, -0.2378, 0.0036}, 0.0034, 0.0006, 6,
              plain(0xd9bb8c));
  builder.rod({0.395, -0.375, 0.0135}, {0.325, -0.300, 0.0135}, 0.0135, 0.0125, 14,
              striped(0xd09a33, 0xb07f24, 0.009F, 0.6F), plain(0xb07f24));
  builder.rod({0.325, -0.300, 0.0135}, {0.255, -0.225, 0.009}, 0.0032, 0.0032, 10,
              polished(0xa9adae));
  // A brass gear blank beside the motor, and a roll of tape.
  builder.cylinder(
      uprightPose({-0.285, 0.065, 0}), {0.034, 0.034, 0.016, 28},
      striped(0xb08b40, 0x7f6228, 0.0089F, 0.55F), [](Canvas& canvas) {
        plain(0xc09a4b)(canvas);
        canvas.paint({}, canvas.half(), [&](glm::vec2 p) {
          const Paint rim = canvas.fill(linearFromSrgb(0x8f6f30), ringDistance(p, 0.023F, 0.004F));
          return over(canvas.fill(linearFromSrgb(0x2c2318), discDistance(p, 0.007F)), rim);
        });
      });
  builder.cylinder(uprightPose({0.925, 0.10, 0}), {0.052, 0.052, 0.048, 32}, plain(0xd3b98a),
                   [](Canvas& canvas) {
                     plain(0xbfa271)(canvas);
                     canvas.paint({}, canvas.half(), [&](glm::vec2 p) {
                       return canvas.fill(linearFromSrgb(0x5a4630), discDistance(p, 0.034F));
                     });
                   });
  builder.box(uprightPose({-0.93, 0.22, 0}, -9), {0.30, 0.24, 0.21}, {.other = cardboard()});
  builder.box(uprightPose({-0.90, 0.22, 0.21}, 6), {0.19, 0.15, 0.07}, {.other = enamel(0x4c7f7a)});
}

}  // namespace

void buildClutter(Builder& builder) {
  buildMug(builder);
  buildBooks(builder);
  buildBins(builder);
  buildOilCan(builder);
  buildSmallThings(builder);
}

}  // namespace pleinair::hal::synthetic
