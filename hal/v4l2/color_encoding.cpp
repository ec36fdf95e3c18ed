#include "hal/v4l2/color_encoding.h"

#include <linux/videodev2.h>

namespace pleinair::hal::v4l2 {

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
