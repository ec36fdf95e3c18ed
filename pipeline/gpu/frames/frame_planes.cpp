#include "pipeline/gpu/frames/frame_planes.h"

namespace pleinair::gpu {
namespace {

using hal::FrameSize;
using hal::PixelFormat;

constexpr std::uint32_t kR8 = hal::drmFourcc('R', '8', ' ', ' ');
constexpr std::uint32_t kGr88 = hal::drmFourcc('G', 'R', '8', '8');  ///< bytes R, G
constexpr std::uint32_t kAbgr8888 = hal::drmFourcc('A', 'B', '2', '4');
constexpr std::uint32_t kBgr888 = hal::drmFourcc('B', 'G', '2', '4');

PlaneTexture bytes(FrameSize size, TextureFilter filter = TextureFilter::kNearest) {
  return {.format = TextureFormat::kR8, .size = size, .filter = filter, .fourcc = kR8};
}

}  // namespace

PlaneTexture uploadedPlane(const hal::FrameFormat& format, int plane) {
  const FrameSize full = format.size;
  const FrameSize half{(full.width + 1) / 2, (full.height + 1) / 2};
  switch (format.pixelFormat) {
    case PixelFormat::kRgb8:
      return {.format = TextureFormat::kRgb8, .size = full, .fourcc = kBgr888};
    case PixelFormat::kRgba8:
      return {.format = TextureFormat::kRgba8, .size = full, .fourcc = kAbgr8888};
    case PixelFormat::kYuyv:
      return {
          .format = TextureFormat::kRgba8, .size = {half.width, full.height}, .fourcc = kAbgr8888};
    case PixelFormat::kNv12:
      if (plane == 0) return bytes(full);
      return {.format = TextureFormat::kRg8,
              .size = half,
              .filter = TextureFilter::kLinear,
              .fourcc = kGr88};
    case PixelFormat::kI420:
      return plane == 0 ? bytes(full) : bytes(half, TextureFilter::kLinear);
    default:
      return bytes(full);
  }
}

PlaneTexture importedPlane(const hal::FrameFormat& format, int plane) {
  if (format.pixelFormat == PixelFormat::kRgb8) {
    return bytes({3 * format.size.width, format.size.height});
  }
  return uploadedPlane(format, plane);
}

}  // namespace pleinair::gpu
