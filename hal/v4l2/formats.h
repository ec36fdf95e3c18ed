#pragma once

#include <cstdint>
#include <string>

#include "hal/pixel_format.h"

namespace pleinair::hal::v4l2 {

/// A fourcc as text, as v4l2-ctl writes it: "YUYV", with non-printable bytes as "\x1f", without
/// trailing spaces, and with "-BE" for the big-endian flag (bit 31).
std::string fourccText(std::uint32_t fourcc);

/// The Y'CbCr encoding that v4l2_pix_format's fields give; "default" values follow the kernel's
/// rules. BT.2020 and SMPTE 240M are not supported and count as BT.709, the nearest.
ColorEncoding colorEncodingOf(std::uint32_t colorspace, std::uint32_t encoding,
                              std::uint32_t quantization);

/// `encoding` with the primaries and the transfer function of a V4L2 colour space; `transfer` may
/// be the default one.
ColorEncoding withColorimetry(ColorEncoding encoding, std::uint32_t colorspace,
                              std::uint32_t transfer);

}  // namespace pleinair::hal::v4l2
