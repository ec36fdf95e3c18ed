#include "hal/cameras/synthetic/render/sampler.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstring>

namespace pleinair::hal::synthetic {
namespace {

// The compilers' portable vector types: SSE and NEON alike.
using Byte16 = std::uint8_t __attribute__((vector_size(16)));
using Word8 = std::uint16_t __attribute__((vector_size(16)));
using Float4 = float __attribute__((vector_size(16)));
using Int4 = std::int32_t __attribute__((vector_size(16)));

constexpr int kStep = 8;  // pixels between exact perspective divisions
/// Selects a finer level than the footprint asks for: edges stay sharp, and the two taps keep them
/// from flickering.
constexpr float kLevelBias = -0.75F;
constexpr float kSubTexels = 128;

/// Reads one mip level of a texture at texel coordinates, counted from the texture's outer corner.
struct Reader {
  const MipTexture::Level* level = nullptr;
  float scale = 1;  ///< texels of this level per texel of the finest

  /// Bilinear sample between texel centres: channels of 0 to 65280, in the lower half.
  Word8 at(float u, float v) const {
    const float highX = static_cast<float>(level->width) - 1.01F;
    const float highY = static_cast<float>(level->height) - 1.01F;
    const float x = std::min(std::max(u * scale - 0.5F, 0.0F), highX) * kSubTexels;
    const float y = std::min(std::max(v * scale - 0.5F, 0.0F), highY) * kSubTexels;
    const auto fixedX = static_cast<std::int32_t>(x);
    const auto fixedY = static_cast<std::int32_t>(y);
    const Texel* texel =
        level->texels.data() + std::ptrdiff_t{fixedY >> 7} * level->width + (fixedX >> 7);
    const auto tx = static_cast<std::uint16_t>(fixedX & 127);
    const auto ty = static_cast<std::uint16_t>(fixedY & 127);
    const Word8 both =
        (pair(texel) * static_cast<std::uint16_t>(128 - ty) + pair(texel + level->width) * ty) >> 6;
    const auto rest = static_cast<std::uint16_t>(128 - tx);
    const Word8 weights{rest, rest, rest, rest, tx, tx, tx, tx};
    const Word8 weighted = both * weights;
    return weighted + __builtin_shufflevector(weighted, weighted, 4, 5, 6, 7, 0, 1, 2, 3);
  }

 private:
  /// Reads a texel and its right neighbour. Widens with zero bytes, for little-endian machines (the
  /// only ones supported).
  static Word8 pair(const Texel* texel) {
    Byte16 bytes{};
    std::memcpy(&bytes, texel, 2 * sizeof(Texel));
    const Byte16 zero{};
    return Word8(__builtin_shufflevector(bytes, zero, 0, 16, 1, 17, 2, 18, 3, 19, 4, 20, 5, 21, 6,
                                         22, 7, 23));
  }
};

/// A point in texels of the finest level, from the texture's outer corner.
struct Point {
  float u = 0, v = 0;
};

/// The perspective mapping from the image to one facet's texels.
struct Perspective {
  const ProjectedFacet& facet;
  double texelsPerMetre;
  double halfU, halfV;  ///< metres

  Point at(double px, double py) const {
    const double depth = 1 / facet.inverseDepth.at(px, py);
    return {static_cast<float>((facet.uOverDepth.at(px, py) * depth + halfU) * texelsPerMetre),
            static_cast<float>((facet.vOverDepth.at(px, py) * depth + halfV) * texelsPerMetre)};
  }
  /// The derivatives of the texture point with respect to the pixel's x and y.
  void derivatives(double px, double py, Point& alongX, Point& alongY) const {
    const double depth = 1 / facet.inverseDepth.at(px, py);
    const double u = facet.uOverDepth.at(px, py) * depth;
    const double v = facet.vOverDepth.at(px, py) * depth;
    const double scale = depth * texelsPerMetre;
    const ImageLinear& d = facet.inverseDepth;
    alongX = {static_cast<float>((facet.uOverDepth.x - u * d.x) * scale),
              static_cast<float>((facet.vOverDepth.x - v * d.x) * scale)};
    alongY = {static_cast<float>((facet.uOverDepth.y - u * d.y) * scale),
              static_cast<float>((facet.vOverDepth.y - v * d.y) * scale)};
  }
};

float squaredLength(Point p) {
  return p.u * p.u + p.v * p.v;
}

/// The texture filter for a run of pixels.
struct Footprint {
  Reader fine, coarse;
  std::uint16_t coarseShare = 0;  ///< weight of the coarser level, of 128
  bool isLong = false;
  Point tap;  ///< offset from the pixel to either tap along the longer side
};

Footprint footprintOf(const PatchTexture& texture, Point alongX, Point alongY) {
  float longer = squaredLength(alongX);
  float shorter = squaredLength(alongY);
  Point along = alongX;
  if (longer < shorter) {
    std::swap(longer, shorter);
    along = alongY;
  }
  Footprint footprint;
  footprint.isLong = longer > 1.7F * shorter;
  footprint.tap = {0.25F * along.u, 0.25F * along.v};
  const float texels = std::max({shorter, longer / 4, 1e-12F});  // squared length
  const auto& levels = texture.texture.levels();
  const float lod = std::clamp(0.5F * std::log2(texels) + kLevelBias, 0.0F,
                               static_cast<float>(levels.size()) - 1);
  const auto index = static_cast<std::size_t>(lod);
  const std::size_t next = std::min(index + 1, levels.size() - 1);
  footprint.fine = {&levels[index], 1 / static_cast<float>(1U << index)};
  footprint.coarse = {&levels[next], 1 / static_cast<float>(1U << next)};
  footprint.coarseShare =
      // NOLINTNEXTLINE(bugprone-incorrect-roundings): never negative
      static_cast<std::uint16_t>(128 * (lod - static_cast<float>(index)) + 0.5F);
  return footprint;
}

Word8 read(const Footprint& footprint, const Reader& reader, Point at) {
  if (!footprint.isLong) return reader.at(at.u, at.v);
  return (reader.at(at.u - footprint.tap.u, at.v - footprint.tap.v) >> 1) +
         (reader.at(at.u + footprint.tap.u, at.v + footprint.tap.v) >> 1);
}

Word8 read(const Footprint& footprint, Point at) {
  const Word8 fine = read(footprint, footprint.fine, at);
  if (footprint.coarseShare == 0) return fine;
  const Word8 coarse = read(footprint, footprint.coarse, at);
  const auto rest = static_cast<std::uint16_t>(128 - footprint.coarseShare);
  return ((fine + 64) >> 7) * rest + ((coarse + 64) >> 7) * footprint.coarseShare;
}

}  // namespace

void sample(const ProjectedFacet& facet, const PatchTexture& texture, int x, int y, int count,
            std::int16_t* levels) {
  const Perspective perspective{facet, 1 / static_cast<double>(texture.texelMetres),
                                static_cast<double>(texture.half.x),
                                static_cast<double>(texture.half.y)};
  const double py = y + 0.5;
  Point from = perspective.at(x + 0.5, py);
  for (int begin = 0; begin < count; begin += kStep) {
    const int steps = std::min(kStep, count - begin);
    const double px = x + begin + 0.5;
    Point alongX;
    Point alongY;
    perspective.derivatives(px + (steps - 1) * 0.5, py, alongX, alongY);
    const Footprint footprint = footprintOf(texture, alongX, alongY);
    const Point to = steps == 1 ? from : perspective.at(px + steps, py);
    const Point step{(to.u - from.u) / static_cast<float>(steps),
                     (to.v - from.v) / static_cast<float>(steps)};
    Point at = from;
    for (int i = 0; i < steps; ++i) {
      const Word8 level = read(footprint, at) >> 2;
      std::memcpy(levels, &level, 4 * sizeof(std::int16_t));
      levels += 3;
      at = {at.u + step.u, at.v + step.v};
    }
    from = to;
  }
}

}  // namespace pleinair::hal::synthetic
