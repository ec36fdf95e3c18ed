#include "hal/pixel_format.h"

#include <cassert>

namespace pleinair::hal {
namespace {

std::size_t asSize(int value) {
  return static_cast<std::size_t>(value);
}
int halfRoundedUp(int value) {
  return (value + 1) / 2;
}

}  // namespace

bool isAcceptedSize(FrameSize size) {
  return size.width >= 1 && size.height >= 1 && size.width <= kMaxSidePixels &&
         size.height <= kMaxSidePixels && size.pixels() <= kMaxPixels;
}

int planeCount(PixelFormat format) {
  if (format == PixelFormat::kI420) return 3;
  return format == PixelFormat::kNv12 ? 2 : 1;
}

std::size_t rowBytes(PixelFormat format, int plane, int width) {
  assert(plane >= 0 && plane < planeCount(format));
  switch (format) {
    case PixelFormat::kRgb8:
      return asSize(width) * 3;
    case PixelFormat::kRgba8:
      return asSize(width) * 4;
    case PixelFormat::kYuyv:
      return asSize(halfRoundedUp(width)) * 4;
    case PixelFormat::kNv12:
      return plane == 0 ? asSize(width) : asSize(halfRoundedUp(width)) * 2;
    case PixelFormat::kI420:
      return plane == 0 ? asSize(width) : asSize(halfRoundedUp(width));
    default:
      return asSize(width);
  }
}

int planeRows(PixelFormat format, int plane, int height) {
  assert(plane >= 0 && plane < planeCount(format));
  const bool subsampled = format == PixelFormat::kNv12 || format == PixelFormat::kI420;
  return subsampled && plane > 0 ? halfRoundedUp(height) : height;
}

bool isYCbCr(PixelFormat format) {
  return format == PixelFormat::kYuyv || format == PixelFormat::kNv12 ||
         format == PixelFormat::kI420;
}

bool isBayer(PixelFormat format) {
  return format == PixelFormat::kBayerRggb8 || format == PixelFormat::kBayerGrbg8 ||
         format == PixelFormat::kBayerGbrg8 || format == PixelFormat::kBayerBggr8;
}

std::string_view toString(PixelFormat format) {
  switch (format) {
    case PixelFormat::kGrey8:
      return "grey8";
    case PixelFormat::kRgb8:
      return "rgb8";
    case PixelFormat::kRgba8:
      return "rgba8";
    case PixelFormat::kYuyv:
      return "yuyv";
    case PixelFormat::kNv12:
      return "nv12";
    case PixelFormat::kI420:
      return "i420";
    case PixelFormat::kBayerRggb8:
      return "bayer-rggb8";
    case PixelFormat::kBayerGrbg8:
      return "bayer-grbg8";
    case PixelFormat::kBayerGbrg8:
      return "bayer-gbrg8";
    case PixelFormat::kBayerBggr8:
      return "bayer-bggr8";
  }
  return "unknown";
}

}  // namespace pleinair::hal
