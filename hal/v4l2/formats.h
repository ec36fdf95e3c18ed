#pragma once

#include <cstdint>
#include <string>

#include "hal/pixel_format.h"

namespace pleinair::hal::v4l2 {

/// "YUYV"; bytes that are no printable ASCII as "\x1f", spaces at the end left out, and the
/// big-endian flag (bit 31) as "-BE", as v4l2-ctl writes it.
std::string fourccText(std::uint32_t fourcc);

/// The Y'CbCr encoding that v4l2_pix_format's fields say, with the kernel's defaults where they say
/// "default". BT.2020 and SMPTE 240M, which the painter does not know, count as the nearest:
/// BT.709.
ColorEncoding colorEncodingOf(std::uint32_t colorspace, std::uint32_t encoding,
                              std::uint32_t quantization);

}  // namespace pleinair::hal::v4l2
