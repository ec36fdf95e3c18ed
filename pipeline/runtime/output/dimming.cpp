#include "pipeline/runtime/output/dimming.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <span>

namespace pleinair::runtime {
namespace {

/// Bytes 0 and 2 of a pixel, and bytes 1 and 3, each in 16 bits.
constexpr std::uint32_t kEvenBytes = 0x00FF00FF;
constexpr std::uint32_t kHalves = 0x00800080;
/// Alpha, the last byte in memory, of a little-endian machine.
constexpr std::uint32_t kAlpha = 0xFF000000;

std::uint32_t dimmed(std::uint32_t pixel, Brightness brightness) {
  const std::uint32_t even = (pixel & kEvenBytes) * brightness + kHalves;
  const std::uint32_t odd = ((pixel >> 8U) & kEvenBytes) * brightness + kHalves;
  return (((even >> 8U) & kEvenBytes) | (odd & ~kEvenBytes & ~kAlpha)) | (pixel & kAlpha);
}

}  // namespace

Brightness brightnessOf(double share) {
  return static_cast<Brightness>(std::lround(kFullBrightness * std::clamp(share, 0.0, 1.0)));
}

void dim(const hal::ImageView& from, Brightness brightness, hal::Image& into) {
  assert(from.format.pixelFormat == hal::PixelFormat::kRgba8 && from.format == into.format());
  constexpr std::size_t kPixelBytes = 4;
  for (int y = 0; y < from.format.size.height; ++y) {
    const std::span<const std::uint8_t> bright = from.row(0, y);
    const std::span<std::uint8_t> row = into.row(0, y);
    for (std::size_t i = 0; i + kPixelBytes <= row.size(); i += kPixelBytes) {
      std::uint32_t pixel = 0;
      std::memcpy(&pixel, &bright[i], kPixelBytes);
      pixel = dimmed(pixel, brightness);
      std::memcpy(&row[i], &pixel, kPixelBytes);
    }
  }
}

}  // namespace pleinair::runtime
