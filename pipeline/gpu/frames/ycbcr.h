#pragma once

#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

#include "hal/pixel_format.h"

namespace pleinair::gpu {

/// Conversion between R'G'B' and Y'CbCr, all coded in [0, 1]: rgb = toRgb · (ycbcr − offset) and
/// ycbcr = fromRgb · rgb + offset. From the luma weights of ITU-R BT.601-7 §2.5 and BT.709-6 §3.
struct YcbcrConversion {
  glm::mat3 toRgb;
  glm::mat3 fromRgb;
  glm::vec3 offset;
};
YcbcrConversion ycbcrConversion(hal::ColorEncoding encoding);

/// Whether 4:2:0 chroma sits on the even columns (MPEG-2, limited range) or between (JPEG, full
/// range).
bool isChromaLeftSited(hal::ColorEncoding encoding);

}  // namespace pleinair::gpu
