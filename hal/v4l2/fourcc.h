#pragma once

#include <cstdint>
#include <string>

namespace pleinair::hal::v4l2 {

/// "YUYV"; bytes that are no printable ASCII as "\x1f", spaces at the end left out, and the
/// big-endian flag (bit 31) as "-BE", as v4l2-ctl writes it.
std::string fourccText(std::uint32_t fourcc);

}  // namespace pleinair::hal::v4l2
