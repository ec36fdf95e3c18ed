#include "hal/media/orientation.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cstddef>
#include <cstdlib>
#include <utility>

namespace pleinair::hal::libav {
namespace {

/// Whether one diagonal of a matrix outweighs the other so far that the matrix turns by less than a
/// degree.
bool outweighs(std::array<std::int64_t, 2> diagonal, std::array<std::int64_t, 2> other) {
  constexpr std::int64_t kOverTanOfADegree = 57;
  const std::int64_t least = std::min(std::abs(diagonal[0]), std::abs(diagonal[1]));
  const std::int64_t most = std::max(std::abs(other[0]), std::abs(other[1]));
  return least > 0 && most * kOverTanOfADegree <= least;
}

/// Bytes from one pixel of a plane to the next.
std::size_t pixelBytes(PixelFormat format, int plane) {
  assert(format != PixelFormat::kYuyv && !isBayer(format));
  return rowBytes(format, plane, 2) / (isYCbCr(format) && plane > 0 ? 1 : 2);
}

template <std::size_t kPixelBytes>
void turnPlane(const PlaneView& stored, FrameSize size, Orientation orientation,
               std::span<std::uint8_t> target) {
  constexpr auto kBytes = static_cast<std::ptrdiff_t>(kPixelBytes);
  std::ptrdiff_t right = kBytes;
  auto down = static_cast<std::ptrdiff_t>(stored.strideBytes);
  const std::uint8_t* first = stored.bytes.data();
  if (orientation.fromRight) {
    first += right * (size.width - 1);
    right = -right;
  }
  if (orientation.fromBottom) {
    first += down * (size.height - 1);
    down = -down;
  }
  if (orientation.transposed) std::swap(right, down);
  const FrameSize shown = oriented(size, orientation);
  // Width of a strip. The stored rows that a transposed strip crosses stay in the cache.
  constexpr int kStripPixels = 64;
  for (int strip = 0; strip < shown.width; strip += kStripPixels) {
    const int end = std::min(strip + kStripPixels, shown.width);
    for (int y = 0; y < shown.height; ++y) {
      const std::uint8_t* from = first + right * strip + down * y;
      std::uint8_t* to = target.data() + (std::ptrdiff_t{y} * shown.width + strip) * kBytes;
      for (int x = strip; x < end; ++x, from += right, to += kBytes) {
        std::copy_n(from, kBytes, to);
      }
    }
  }
}

}  // namespace

Orientation orientationOf(std::span<const std::int32_t, 9> displayMatrix) {
  const std::int64_t a = displayMatrix[0];
  const std::int64_t b = displayMatrix[1];
  const std::int64_t c = displayMatrix[3];
  const std::int64_t d = displayMatrix[4];
  if (outweighs({a, d}, {b, c}))
    return {.transposed = false, .fromRight = a < 0, .fromBottom = d < 0};
  if (outweighs({b, c}, {a, d}))
    return {.transposed = true, .fromRight = b < 0, .fromBottom = c < 0};
  return {};
}

FrameSize oriented(FrameSize size, Orientation orientation) {
  return orientation.transposed ? FrameSize{size.height, size.width} : size;
}

Image oriented(const ImageView& stored, Orientation orientation) {
  FrameFormat format = stored.format;
  format.size = oriented(format.size, orientation);
  Image image(format);
  for (int plane = 0; plane < planeCount(format.pixelFormat); ++plane) {
    const std::size_t bytes = pixelBytes(format.pixelFormat, plane);
    const FrameSize size{
        static_cast<int>(rowBytes(format.pixelFormat, plane, stored.format.size.width) / bytes),
        planeRows(format.pixelFormat, plane, stored.format.size.height)};
    const PlaneView& from = stored.planes[static_cast<std::size_t>(plane)];
    switch (bytes) {
      case 1:
        turnPlane<1>(from, size, orientation, image.plane(plane));
        break;
      case 2:
        turnPlane<2>(from, size, orientation, image.plane(plane));
        break;
      case 3:
        turnPlane<3>(from, size, orientation, image.plane(plane));
        break;
      default:
        turnPlane<4>(from, size, orientation, image.plane(plane));
    }
  }
  return image;
}

}  // namespace pleinair::hal::libav
