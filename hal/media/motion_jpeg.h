#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "hal/error.h"
#include "hal/media/frame_pixels.h"

namespace pleinair::hal::libav {

/// A camera's JPEG as I420 with full range, whatever chroma it stores: 4:2:0 is lent without a
/// copy, other chroma averaged, none is neutral. Rows and columns as stored; the Huffman tables may
/// be left out, as Motion-JPEG does. `subject` names the camera in errors: kInvalidInput (not a
/// JPEG, truncated or corrupt), kUnsupported (size, coding).
Result<LentPicture> decodeMotionJpeg(std::span<const std::uint8_t> bytes,
                                     const std::string& subject);

}  // namespace pleinair::hal::libav
