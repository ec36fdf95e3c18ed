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

std::string_view toString(ColorPrimaries primaries) {
  switch (primaries) {
    case ColorPrimaries::kUnknown:
      return "unknown";
    case ColorPrimaries::kBt709:
      return "bt709";
    case ColorPrimaries::kSmpte170m:
      return "smpte170m";
    case ColorPrimaries::kBt470bg:
      return "bt470bg";
    case ColorPrimaries::kBt2020:
      return "bt2020";
    case ColorPrimaries::kOther:
      return "other";
  }
  return "unknown";
}

std::string_view toString(ColorTransfer transfer) {
  switch (transfer) {
    case ColorTransfer::kUnknown:
      return "unknown";
    case ColorTransfer::kBt709:
      return "bt709";
    case ColorTransfer::kSrgb:
      return "srgb";
    case ColorTransfer::kLinear:
      return "linear";
    case ColorTransfer::kPq:
      return "pq";
    case ColorTransfer::kOther:
      return "other";
  }
  return "unknown";
}

std::uint32_t drmFourccOf(PixelFormat format) {
  switch (format) {
    case PixelFormat::kRgb8:
      return drmFourcc('B', 'G', '2', '4');
    case PixelFormat::kRgba8:
      return drmFourcc('A', 'B', '2', '4');
    case PixelFormat::kYuyv:
      return drmFourcc('Y', 'U', 'Y', 'V');
    case PixelFormat::kNv12:
      return drmFourcc('N', 'V', '1', '2');
    case PixelFormat::kI420:
      return drmFourcc('Y', 'U', '1', '2');
    default:
      return drmFourcc('R', '8', ' ', ' ');
  }
}

}  // namespace pleinair::hal
