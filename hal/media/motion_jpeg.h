#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "hal/error.h"
#include "hal/media/frame_pixels.h"

namespace pleinair::hal::libav {

/// Decodes a camera's JPEG to I420 with full range: 4:2:0 is lent without a copy, other chroma is
/// averaged, missing chroma is neutral. Rows and columns stay as stored. The Huffman tables may be
/// missing, as in Motion-JPEG. `subject` names the camera in errors: kInvalidInput (not a JPEG,
/// truncated or corrupt), kUnsupported (size, coding).
Result<LentPicture> decodeMotionJpeg(std::span<const std::uint8_t> bytes,
                                     const std::string& subject);

}  // namespace pleinair::hal::libav
