#include "hal/cameras/synthetic/world/papers.h"

#include <array>
#include <cmath>

#include "hal/cameras/synthetic/world/noise.h"
#include "hal/cameras/synthetic/world/srgb.h"

namespace pleinair::hal::synthetic {
namespace {

/// The share of white cells in a square texel at `p` (tag frame, metres).
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
  const float depth = 0.9F / static_cast<float>(teeth);
  return glm::length(p) - radius * (1 + depth * glm::smoothstep(-0.45F, 0.45F, wave));
}

}  // namespace

void paintTagCard(Canvas& canvas, const Placement& at, const BenchTag& tag) {
  const TagBitmap bitmap = tag36h11Bitmap(tag.id);
  const auto edge = static_cast<float>(tag.edgeMetres);
  const float cell = edge / kTagCellsPerEdge;
  const glm::vec2 half(cell * kTagCells / 2 + 0.003F);
  const glm::vec3 white(0.78F, 0.77F, 0.74F);
  const glm::vec3 black(0.024F, 0.024F, 0.026F);
  canvas.shadow(at, half, 0.002F, 0.0020F);
  canvas.paint(at, half + canvas.texelMetres(), [&](glm::vec2 p) {
    // The tag's y runs down as it is read; the placement's y runs up.
    const float whiteness = tagWhiteness(bitmap, {p.x, -p.y}, canvas.texelMetres(), cell);
    return canvas.fill(glm::mix(black, white, whiteness), boxDistance(p, half, 0.002F));
  });
}

void paintPoster(Canvas& canvas) {
  const glm::vec2 half = canvas.half();
  const float unit = half.x / 0.15F;
  const glm::vec3 cream = linearFromSrgb(0xeadfc3), red = linearFromSrgb(0xc24a2e),
                  blue = linearFromSrgb(0x2d5a78), ochre = linearFromSrgb(0xdca23c),
                  ink = linearFromSrgb(0x2a2d31);
  canvas.paintAll([&](glm::vec2 world) {
    const glm::vec2 p = world / unit;
    const glm::vec2 frame = half / unit - 0.010F;
    Paint top{cream, 1};
    const auto lay = [&](glm::vec3 colour, float distance) {
      top = over(canvas.fill(colour, unit * std::max(distance, boxDistance(p, frame))), top);
    };
    lay(blue, std::max(p.y + 0.055F, -1.0F));
    lay(ochre, discDistance(p - glm::vec2(0.035F, 0.060F), 0.088F));
    lay(red, gearDistance(p - glm::vec2(-0.035F, -0.035F), 0.078F, 16));
    lay(cream, discDistance(p - glm::vec2(-0.035F, -0.035F), 0.052F));
    lay(red, discDistance(p - glm::vec2(-0.035F, -0.035F), 0.030F));
    lay(cream, discDistance(p - glm::vec2(-0.035F, -0.035F), 0.011F));
    lay(ink, std::abs(gearDistance(p - glm::vec2(0.072F, 0.078F), 0.034F, 10)) - 0.002F);
    for (int bar = 0; bar < 3; ++bar) {
      const float length = 0.098F - 0.030F * static_cast<float>(bar);
      const float y = -0.152F - 0.014F * static_cast<float>(bar);
      lay(cream,
          boxDistance(p - glm::vec2(-0.128F + length, y), {length, bar == 0 ? .005F : .0025F}));
    }
    lay(ink, boxDistance(p - glm::vec2(-0.075F, 0.172F), {0.055F, 0.008F}));
    return top.linearRgb;
  });
}

void paintDrawing(Canvas& canvas, const Placement& at) {
  const glm::vec2 half(0.21F, 0.148F);
  const glm::vec3 paper = linearFromSrgb(0xe9e6da), line = linearFromSrgb(0x3e5a78),
                  red = linearFromSrgb(0xb4513c);
  canvas.shadow(at, half, 0, 0.0016F);
  canvas.paint(at, half + canvas.texelMetres(), [&](glm::vec2 p) {
    Paint top = canvas.fill(paper, boxDistance(p, half));
    const auto draw = [&](float distance, float width, glm::vec3 colour) {
      top = over(canvas.fill(colour, std::abs(distance) - width / 2, 0.85F * top.coverage), top);
    };
    draw(boxDistance(p, half - 0.010F), 0.0010F, line);
    const glm::vec2 wheel = p - glm::vec2(-0.080F, 0.012F);
    draw(gearDistance(wheel, 0.074F, 22), 0.0013F, line);
    draw(discDistance(wheel, 0.060F), 0.0008F, line);
    draw(discDistance(wheel, 0.026F), 0.0013F, line);
    draw(discDistance(wheel, 0.011F), 0.0013F, line);
    const glm::vec2 pinion = p - glm::vec2(0.030F, 0.036F);
    draw(gearDistance(pinion, 0.036F, 11), 0.0013F, line);
    draw(discDistance(pinion, 0.010F), 0.0013F, line);
    draw(std::max(std::abs(p.y - 0.012F) - 0.0002F, std::abs(p.x + 0.080F) - 0.098F), 0.0006F, red);
    draw(std::max(std::abs(p.x + 0.080F) - 0.0002F, std::abs(p.y - 0.012F) - 0.098F), 0.0006F, red);
    const glm::vec2 section = p - glm::vec2(0.134F, 0.030F);
    draw(boxDistance(section, {0.024F, 0.080F}), 0.0013F, line);
    draw(boxDistance(section, {0.014F, 0.030F}), 0.0013F, line);
    draw(boxDistance(section - glm::vec2(0, 0.055F), {0.024F, 0.012F}), 0.0010F, line);
    draw(boxDistance(section + glm::vec2(0, 0.055F), {0.024F, 0.012F}), 0.0010F, line);
    const glm::vec2 title = p - glm::vec2(0.130F, -0.110F);
    draw(boxDistance(title, {0.070F, 0.028F}), 0.0010F, line);
    draw(std::max(std::abs(title.y), std::abs(title.x) - 0.070F), 0.0010F, line);
    top = over(canvas.fill(line, boxDistance(title - glm::vec2(-0.020F, 0.014F), {0.042F, 0.004F}),
                           0.8F * top.coverage),
               top);
    return top;
  });
}

void paintNotes(Canvas& canvas, const Placement& at, glm::vec2 half, std::uint32_t seed) {
  const glm::vec3 paper = linearFromSrgb(0xece8dc), ink = linearFromSrgb(0x4a5361);
  canvas.shadow(at, half, 0, 0.0016F);
  canvas.paint(at, half + canvas.texelMetres(), [&](glm::vec2 p) {
    Paint top = canvas.fill(paper, boxDistance(p, half));
    const float fromTop = half.y - p.y;
    const float line = std::floor((fromTop - 0.026F) / 0.012F);
    const auto lines = static_cast<float>(static_cast<int>((half.y * 1.2F) / 0.012F));
    if (line >= 0 && line < lines && std::abs(p.x) < half.x - 0.020F) {
      const auto lineId = seed + 31U * static_cast<std::uint32_t>(line);
      const float fromBaseline = fromTop - 0.026F - (line + 0.5F) * 0.012F;
      const bool isWord = valueNoise(lineId, {p.x * 70, 0}) > 0.30F;
      const float end = half.x - 0.020F - 0.05F * static_cast<float>(unitRandom(lineId, 1));
      if (isWord && p.x < end) {
        top = over(canvas.fill(ink, std::abs(fromBaseline) - 0.0014F, 0.6F), top);
      }
    }
    const glm::vec2 sketch = p - glm::vec2(0.2F * half.x, -0.6F * half.y);
    for (const float distance : {std::abs(gearDistance(sketch, 0.24F * half.x, 12)),
                                 std::abs(discDistance(sketch, 0.09F * half.x))}) {
      top = over(canvas.fill(linearFromSrgb(0xb4513c), distance - 0.0007F, 0.8F), top);
    }
    return top;
  });
}

void paintStickyNote(Canvas& canvas, const Placement& at, std::uint32_t srgb) {
  const glm::vec2 half(0.038F);
  const glm::vec3 paper = linearFromSrgb(srgb), ink = linearFromSrgb(0x3a3a42);
  canvas.shadow(at, half, 0, 0.0024F);
  canvas.paint(at, half + canvas.texelMetres(), [&](glm::vec2 p) {
    const float curl = 1 - 0.14F * glm::smoothstep(0.0F, -0.038F, p.y);
    Paint top = canvas.fill(paper * curl, boxDistance(p, half));
    for (int line = 0; line < 3; ++line) {
      const float y = 0.016F - 0.014F * static_cast<float>(line);
      const float length = 0.026F - 0.007F * static_cast<float>(line);
      const float distance = std::max(std::abs(p.y - y) - 0.0012F, std::abs(p.x + 0.004F) - length);
      top = over(canvas.fill(ink, distance, 0.7F), top);
    }
    return top;
  });
}

void paintMugRing(Canvas& canvas, const Placement& at) {
  const glm::vec3 stain = linearFromSrgb(0x5a3014);
  canvas.paint(at, glm::vec2(0.048F), [&](glm::vec2 p) {
    const float angle = std::atan2(p.y, p.x);
    const float uneven = 0.5F + 0.5F * std::sin(angle + 0.6F) * std::sin(2 * angle);
    const float distance = std::abs(glm::length(p) - 0.039F) - 0.0006F - 0.0014F * uneven;
    return Paint{stain,
                 (0.14F + 0.18F * uneven) * (1 - glm::smoothstep(-0.001F, 0.0016F, distance))};
  });
}

}  // namespace pleinair::hal::synthetic
