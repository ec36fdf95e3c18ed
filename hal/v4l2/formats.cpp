#include "hal/v4l2/formats.h"

#include <linux/videodev2.h>

namespace pleinair::hal::v4l2 {

std::string fourccText(std::uint32_t fourcc) {
  constexpr std::uint32_t kBigEndian = 1u << 31;
  constexpr char kDigits[] = "0123456789abcdef";
  std::string text;
  for (int shift = 0; shift < 32; shift += 8) {
    const std::uint32_t byte = (fourcc & ~kBigEndian) >> shift & 0xFF;
    if (byte >= ' ' && byte <= '~') {
      text += static_cast<char>(byte);
    } else {
      text += {'\\', 'x', kDigits[byte >> 4], kDigits[byte & 0xF]};
    }
  }
  while (!text.empty() && text.back() == ' ') text.pop_back();
  return (fourcc & kBigEndian) != 0 ? text + "-BE" : text;
}

ColorEncoding colorEncodingOf(std::uint32_t colorspace, std::uint32_t encoding,
                              std::uint32_t quantization) {
  if (encoding == V4L2_YCBCR_ENC_DEFAULT) encoding = V4L2_MAP_YCBCR_ENC_DEFAULT(colorspace);
  if (quantization == V4L2_QUANTIZATION_DEFAULT) {
    quantization = V4L2_MAP_QUANTIZATION_DEFAULT(false, colorspace, encoding);
  }
  const bool is601 = encoding == V4L2_YCBCR_ENC_601 || encoding == V4L2_YCBCR_ENC_XV601;
  return {.matrix = is601 ? ColorMatrix::kBt601 : ColorMatrix::kBt709,
          .range = quantization == V4L2_QUANTIZATION_FULL_RANGE ? ColorRange::kFull
                                                                : ColorRange::kLimited};
}

ColorEncoding withColorimetry(ColorEncoding encoding, std::uint32_t colorspace,
                              std::uint32_t transfer) {
  switch (colorspace) {
    case V4L2_COLORSPACE_DEFAULT:
      return encoding;
    case V4L2_COLORSPACE_REC709:
    case V4L2_COLORSPACE_SRGB:
    case V4L2_COLORSPACE_JPEG:
      encoding.primaries = ColorPrimaries::kBt709;
      break;
    case V4L2_COLORSPACE_SMPTE170M:
    case V4L2_COLORSPACE_SMPTE240M:
      encoding.primaries = ColorPrimaries::kSmpte170m;
      break;
    case V4L2_COLORSPACE_470_SYSTEM_BG:
      encoding.primaries = ColorPrimaries::kBt470bg;
      break;
    case V4L2_COLORSPACE_BT2020:
      encoding.primaries = ColorPrimaries::kBt2020;
      break;
    default:
      encoding.primaries = ColorPrimaries::kOther;
  }
  if (transfer == V4L2_XFER_FUNC_DEFAULT) transfer = V4L2_MAP_XFER_FUNC_DEFAULT(colorspace);
  switch (transfer) {
    case V4L2_XFER_FUNC_709:
      encoding.transfer = ColorTransfer::kBt709;
      break;
    case V4L2_XFER_FUNC_SRGB:
      encoding.transfer = ColorTransfer::kSrgb;
      break;
    case V4L2_XFER_FUNC_NONE:
      encoding.transfer = ColorTransfer::kLinear;
      break;
    case V4L2_XFER_FUNC_SMPTE2084:
      encoding.transfer = ColorTransfer::kPq;
      break;
    default:
      encoding.transfer = ColorTransfer::kOther;
  }
  return encoding;
}

}  // namespace pleinair::hal::v4l2
