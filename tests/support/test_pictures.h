#pragma once

#include <cstdint>

#include "hal/image.h"

namespace pleinair::support {

/// A smooth image that varies with `number`, in any 8-bit format. Chroma stays near neutral, so
/// that subsampling loses little.
inline hal::Image testPicture(hal::FrameFormat format, int number) {
  hal::Image image(format);
  for (int plane = 0; plane < hal::planeCount(format.pixelFormat); ++plane) {
    for (int y = 0; y < hal::planeRows(format.pixelFormat, plane, format.size.height); ++y) {
      const auto row = image.row(plane, y);
      for (std::size_t i = 0; i < row.size(); ++i) {
        const int value =
            plane == 0 ? 40 + static_cast<int>(i) / 2 + y + 11 * number : 118 + number;
        row[i] = static_cast<std::uint8_t>(value % 200 + 20);
      }
    }
  }
  return image;
}

}  // namespace pleinair::support
