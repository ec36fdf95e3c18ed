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

}  // namespace pleinair::hal::v4l2
