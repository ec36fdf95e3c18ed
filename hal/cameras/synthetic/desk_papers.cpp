#include "hal/cameras/synthetic/desk_papers.h"

#include <array>
#include <cmath>

#include <glm/trigonometric.hpp>

#include "hal/cameras/synthetic/noise.h"
#include "hal/cameras/synthetic/tag_bitmap.h"

namespace pleinair::hal::synthetic {
namespace {

/// The share of a square texel at `p` (tag frame, metres) that lies on white cells.
float tagWhiteness(const TagBitmap& bitmap, glm::vec2 p, float texelMetres, float cellMetres) {
  constexpr int kSamples = 4;
  int white = 0;
  for (int sample = 0; sample < kSamples * kSamples; ++sample) {
    const int column = sample % kSamples;
    const int row = sample / kSamples;
    const glm::vec2 offset(static_cast<float>(column) - 1.5F, static_cast<float>(row) - 1.5F);
    const glm::vec2 cell = (p + offset * (texelMetres / kSamples)) / cellMetres + kTagCells / 2.0F;
    const bool onTag = cell.x >= 0 && cell.y >= 0 && cell.x < kTagCells && cell.y < kTagCells;
    if (!onTag || bitmap[static_cast<std::size_t>(cell.y)][static_cast<std::size_t>(cell.x)]) {
      ++white;
    }
  }
  return static_cast<float>(white) / (kSamples * kSamples);
}

/// A gear wheel's outline around the origin.
float gearDistance(glm::vec2 p, float radius, int teeth) {
  const float wave = std::cos(std::atan2(p.y, p.x) * static_cast<float>(teeth));
  return glm::length(p) - radius * (1 + 0.09F * glm::smoothstep(-0.45F, 0.45F, wave));
}

}  // namespace

void paintTagCard(DeskCanvas& canvas, const DeskTag& tag) {
  const TagBitmap bitmap = tag36h11Bitmap(tag.id);
  const auto edge = static_cast<float>(tag.edgeMetres);
  const float cell = edge / kTagCellsPerEdge;
  const glm::vec2 half(cell * kTagCells / 2 + 0.004F);
  const glm::vec3 white(0.80F, 0.80F, 0.78F);
  const glm::vec3 black(0.022F, 0.022F, 0.025F);
  const Placement at{
      glm::vec2(tag.worldFromTag[3]),
      static_cast<float>(glm::degrees(std::atan2(tag.worldFromTag[0].y, tag.worldFromTag[0].x)))};
  canvas.shadow(at, half, 0.002F, 0.0035F);
  canvas.paint(at, half + canvas.texelMetres(), [&](glm::vec2 p) {
    // The tag's y runs down as it is read, the placement's up.
    const float whiteness = tagWhiteness(bitmap, {p.x, -p.y}, canvas.texelMetres(), cell);
    return canvas.fill(glm::mix(black, white, whiteness), boxDistance(p, half, 0.002F));
  });
}

void paintPoster(DeskCanvas& canvas, const Placement& at) {
  const glm::vec2 half(0.15F, 0.20F);
  const glm::vec3 cream = linearFromSrgb(0xf3e8cf), red = linearFromSrgb(0xd7352b),
                  blue = linearFromSrgb(0x1f4e9c), yellow = linearFromSrgb(0xf2b827),
                  ink = linearFromSrgb(0x22201f), teal = linearFromSrgb(0x2b8c83),
                  orange = linearFromSrgb(0xe8772e);
  canvas.shadow(at, half, 0.001F, 0.002F);
  canvas.paint(at, half + canvas.texelMetres(), [&](glm::vec2 p) {
    Paint top = canvas.fill(cream, boxDistance(p, half));
    if (boxDistance(p, half - 0.008F) > 0.001F) return top;
    const auto lay = [&](glm::vec3 colour, float distance) {
      top = over(canvas.fill(colour, std::max(distance, boxDistance(p, half - 0.008F))), top);
    };
    lay(blue, boxDistance(p - glm::vec2(-0.075F, -0.105F), {0.075F, 0.095F}));
    lay(yellow, std::max(discDistance(p - glm::vec2(0.142F, -0.192F), 0.13F), -p.x + 0.012F));
    lay(red, discDistance(p - glm::vec2(0.025F, 0.075F), 0.085F));
    lay(cream, discDistance(p - glm::vec2(0.050F, 0.098F), 0.030F));
    lay(teal, triangleDistance(p, {-0.130F, 0.010F}, {-0.010F, 0.010F}, {-0.070F, 0.150F}));
    lay(orange, discDistance(p - glm::vec2(-0.075F, -0.075F), 0.036F));
    lay(ink, boxDistance(p - glm::vec2(0.075F, -0.022F), {0.062F, 0.006F}));
    lay(ink, boxDistance(p - glm::vec2(0.060F, -0.042F), {0.047F, 0.006F}));
    for (int bar = 0; bar < 5; ++bar) {
      const float x = -0.130F + 0.016F * static_cast<float>(bar);
      lay(cream, boxDistance(p - glm::vec2(x, -0.150F), {0.004F, 0.030F}));
    }
    lay(ink, ringDistance(p - glm::vec2(0.025F, 0.075F), 0.099F, 0.005F));
    lay(ink, boxDistance(p - glm::vec2(-0.100F, 0.176F), {0.032F, 0.008F}));
    return top;
  });
}

void paintWrittenSheet(DeskCanvas& canvas, const Placement& at, std::uint32_t seed) {
  const glm::vec2 half(0.105F, 0.1485F);
  const glm::vec3 paper = linearFromSrgb(0xf4f1e8), ink = linearFromSrgb(0x3b4250),
                  pencil = linearFromSrgb(0xb8452f);
  canvas.shadow(at, half, 0, 0.0018F);
  canvas.paint(at, half + canvas.texelMetres(), [&](glm::vec2 p) {
    Paint top =
        canvas.fill(paper * (0.97F + 0.03F * valueNoise(seed, p * 40.0F)), boxDistance(p, half));
    const float fromTop = half.y - p.y;
    const float line = std::floor((fromTop - 0.030F) / 0.0095F);
    if (line >= 0 && line < 15 && std::abs(p.x) < 0.083F) {
      const auto lineId = seed + 31U * static_cast<std::uint32_t>(line);
      const float fromBaseline = fromTop - 0.030F - (line + 0.5F) * 0.0095F;
      const bool word = valueNoise(lineId, {p.x * 75, 0}) > 0.30F;
      const bool written = p.x < 0.083F - 0.05F * static_cast<float>(unitRandom(lineId, 1)) * 0.7F;
      const float letters = 0.0016F * (0.55F + 0.7F * valueNoise(lineId + 1, {p.x * 420, 0}));
      if (word && written) {
        top = over(canvas.fill(ink, std::abs(fromBaseline) - letters, 0.75F), top);
      }
    }
    top =
        over(canvas.fill(ink, boxDistance(p - glm::vec2(-0.035F, 0.131F), {0.048F, 0.0045F})), top);
    const glm::vec2 q = p - glm::vec2(0.010F, -0.088F);
    for (const float distance :
         {std::abs(gearDistance(q, 0.034F, 12)), std::abs(discDistance(q, 0.022F)),
          std::abs(discDistance(q, 0.008F))}) {
      top = over(canvas.fill(pencil, distance - 0.0007F, 0.85F), top);
    }
    return top;
  });
}

void paintColourChart(DeskCanvas& canvas, const Placement& at) {
  const glm::vec2 half(0.105F, 0.074F);
  constexpr std::array<std::uint32_t, 8> kWashes{0xc8372d, 0xe58a2b, 0xf0c53a, 0x5f9e48,
                                                 0x2d8f8a, 0x2f5fa8, 0x6a4590, 0x7a4a2f};
  const glm::vec3 paper = linearFromSrgb(0xf6f2e6);
  canvas.shadow(at, half, 0, 0.0015F);
  canvas.paint(at, half + canvas.texelMetres(), [&](glm::vec2 p) {
    Paint top = canvas.fill(paper, boxDistance(p, half));
    for (std::size_t wash = 0; wash < kWashes.size(); ++wash) {
      const glm::vec2 centre(-0.0735F + 0.049F * static_cast<float>(wash % 4),
                             wash < 4 ? 0.032F : -0.032F);
      const float ragged =
          0.0025F * fractalNoise(90U + static_cast<std::uint32_t>(wash), p * 260.0F, 2);
      const float distance = boxDistance(p - centre, {0.019F, 0.025F}, 0.006F) + ragged;
      const float thin = glm::clamp((p.y - centre.y) / 0.05F + 0.5F, 0.0F, 1.0F);
      const float rim = glm::smoothstep(-0.0022F, 0.0F, distance);
      top = over(canvas.fill(linearFromSrgb(kWashes[wash]), distance,
                             glm::clamp(0.95F - 0.6F * thin + 0.3F * rim, 0.0F, 1.0F)),
                 top);
    }
    return top;
  });
}

void paintStickyNote(DeskCanvas& canvas, const Placement& at, std::uint32_t srgb) {
  const glm::vec2 half(0.038F);
  const glm::vec3 paper = linearFromSrgb(srgb), ink = linearFromSrgb(0x2a2a35);
  canvas.shadow(at, half, 0, 0.003F);
  canvas.paint(at, half + canvas.texelMetres(), [&](glm::vec2 p) {
    const float curl = 1 - 0.16F * glm::smoothstep(0.0F, -0.038F, p.y);
    Paint top = canvas.fill(paper * curl, boxDistance(p, half));
    for (int line = 0; line < 3; ++line) {
      const float y = 0.018F - 0.014F * static_cast<float>(line);
      const float scribble =
          p.y - y - 0.0026F * std::sin(p.x * 520 + 2.1F * std::sin(p.x * 150 + y * 900));
      const float length = 0.026F - 0.007F * static_cast<float>(line);
      const float distance =
          std::max(std::abs(scribble) - 0.0008F, std::abs(p.x + 0.004F) - length);
      top = over(canvas.fill(ink, distance, 0.85F), top);
    }
    return top;
  });
}

void paintNotebook(DeskCanvas& canvas, const Placement& at, std::uint32_t srgb) {
  const glm::vec2 half(0.105F, 0.148F);
  const glm::vec3 cover = linearFromSrgb(srgb), label = linearFromSrgb(0xefe6d0),
                  band = linearFromSrgb(0xc9402f);
  canvas.shadow(at, half, 0.006F, 0.012F);
  canvas.paint(at, half + canvas.texelMetres(), [&](glm::vec2 p) {
    const float weave = 0.9F + 0.2F * valueNoise(55, p * 900.0F);
    const float edge = boxDistance(p, half, 0.006F);
    const float bevel =
        1 + 0.35F * glm::smoothstep(-0.004F, -0.001F, edge) * (p.y - p.x > 0 ? 1.0F : -1.0F);
    Paint top = canvas.fill(cover * weave * bevel, edge);
    top = over(canvas.fill(cover * 0.45F, std::max(edge, p.x + half.x - 0.022F)), top);
    top = over(
        canvas.fill(label, boxDistance(p - glm::vec2(0.012F, 0.055F), {0.055F, 0.028F}, 0.003F)),
        top);
    top = over(
        canvas.fill(cover * 0.6F, boxDistance(p - glm::vec2(0.012F, 0.060F), {0.042F, 0.0012F})),
        top);
    return over(canvas.fill(band, std::max(edge, std::abs(p.x - 0.082F) - 0.0035F)), top);
  });
}

}  // namespace pleinair::hal::synthetic
