#include "hal/cameras/v4l2/layout.h"

#include <algorithm>
#include <cassert>

#include <linux/videodev2.h>

namespace pleinair::hal::v4l2 {
namespace {

// Checks the constants of the kernel's interface against the kernel's documentation.
static_assert(V4L2_PIX_FMT_YUYV == 0x56595559 && V4L2_PIX_FMT_NV12M == 0x32314D4E);
static_assert(sizeof(v4l2_buffer{}.timestamp) == 2 * sizeof(long));

constexpr Layout kLayouts[] = {
    {.fourcc = V4L2_PIX_FMT_NV12, .pixelFormat = PixelFormat::kNv12},
    {.fourcc = V4L2_PIX_FMT_NV12M, .pixelFormat = PixelFormat::kNv12, .memoryPlanes = 2},
    {.fourcc = V4L2_PIX_FMT_YUV420, .pixelFormat = PixelFormat::kI420},
    {.fourcc = V4L2_PIX_FMT_YUV420M, .pixelFormat = PixelFormat::kI420, .memoryPlanes = 3},
    {.fourcc = V4L2_PIX_FMT_YUYV, .pixelFormat = PixelFormat::kYuyv},
    {.fourcc = V4L2_PIX_FMT_RGB24, .pixelFormat = PixelFormat::kRgb8},
    {.fourcc = V4L2_PIX_FMT_MJPEG, .pixelFormat = PixelFormat::kI420, .isJpeg = true},
    {.fourcc = V4L2_PIX_FMT_JPEG, .pixelFormat = PixelFormat::kI420, .isJpeg = true},
    {.fourcc = V4L2_PIX_FMT_SRGGB8, .pixelFormat = PixelFormat::kBayerRggb8},
    {.fourcc = V4L2_PIX_FMT_SGRBG8, .pixelFormat = PixelFormat::kBayerGrbg8},
    {.fourcc = V4L2_PIX_FMT_SGBRG8, .pixelFormat = PixelFormat::kBayerGbrg8},
    {.fourcc = V4L2_PIX_FMT_SBGGR8, .pixelFormat = PixelFormat::kBayerBggr8},
    {.fourcc = V4L2_PIX_FMT_GREY, .pixelFormat = PixelFormat::kGrey8},
};

}  // namespace

std::span<const Layout> layouts() {
  return kLayouts;
}

const Layout* findLayout(std::uint32_t fourcc) {
  const auto found = std::ranges::find(kLayouts, fourcc, &Layout::fourcc);
  return found == std::end(kLayouts) ? nullptr : found;
}

std::array<PlanePlace, 3> planePlaces(const Layout& layout, FrameSize size,
                                      std::array<std::size_t, 3> memoryStrides) {
  assert(!layout.isJpeg);
  const PixelFormat format = layout.pixelFormat;
  const bool isShared = layout.memoryPlanes == 1;
  const std::size_t lumaStride =
      memoryStrides[0] != 0 ? memoryStrides[0] : rowBytes(format, 0, size.width);
  std::array<PlanePlace, 3> places{};
  std::size_t end = 0;  // of the planes that share a memory plane
  for (int plane = 0; plane < planeCount(format); ++plane) {
    PlanePlace& place = places.at(static_cast<std::size_t>(plane));
    const std::size_t packed = rowBytes(format, plane, size.width);
    const auto rows = static_cast<std::size_t>(planeRows(format, plane, size.height));
    if (isShared) {
      const bool isHalf = format == PixelFormat::kI420 && plane > 0;
      // Two bytes of chroma stand for the last column of an odd width, too.
      place.strideBytes = std::max(isHalf ? lumaStride / 2 : lumaStride, packed);
      place.offsetBytes = end;
      end += place.strideBytes * rows;
    } else {
      const std::size_t given = memoryStrides.at(static_cast<std::size_t>(plane));
      place.memoryPlane = plane;
      place.strideBytes = given != 0 ? given : packed;
    }
    place.sizeBytes = place.strideBytes * (rows - 1) + packed;
  }
  return places;
}

std::size_t neededBytes(const std::array<PlanePlace, 3>& places, PixelFormat format, int index) {
  std::size_t needed = 0;
  for (int plane = 0; plane < planeCount(format); ++plane) {
    const PlanePlace& place = places.at(static_cast<std::size_t>(plane));
    if (place.memoryPlane == index) needed = std::max(needed, place.offsetBytes + place.sizeBytes);
  }
  return needed;
}

}  // namespace pleinair::hal::v4l2
