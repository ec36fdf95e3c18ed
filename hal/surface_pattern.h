#pragma once

#include <array>
#include <cstdint>

#include "hal/error.h"
#include "hal/image.h"
#include "hal/surface.h"

namespace pleinair::hal {

/// The colour (R, G, B) of a pixel of the pattern that is drawn into a surface of a GPU, to see
/// whether it arrives in the output's memory: another one for each pixel of a tile and for each
/// surface, so that wrong layouts, strides, channels and buffers show.
constexpr std::array<std::uint8_t, 3> surfacePatternAt(int x, int y, SurfaceId surface) {
  const auto column = static_cast<std::uint32_t>(x);
  const auto row = static_cast<std::uint32_t>(y);
  const std::uint32_t rest =
      (column >> 8U) * 16U + (row >> 8U) + 37U * static_cast<std::uint32_t>(surface);
  return {static_cast<std::uint8_t>(column & 255U), static_cast<std::uint8_t>(row & 255U),
          static_cast<std::uint8_t>(rest & 255U)};
}

/// Whether an RGBA8 image of a surface's whole buffer is the pattern, to the bit. Error:
/// kUnsupported, which tells of the first pixel that is not.
Result<void> checkSurfacePattern(const ImageView& seen, SurfaceId surface);

}  // namespace pleinair::hal
