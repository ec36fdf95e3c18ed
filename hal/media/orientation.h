#pragma once

#include <cstdint>
#include <span>

#include "hal/image.h"

namespace pleinair::hal::libav {

/// The mapping from the upright image to the stored one. Pixel (x, y) of the upright image is
/// stored in column x and row y or, if transposed, in column y and row x; columns count from the
/// right and rows from the bottom if the flags say so.
struct Orientation {
  bool transposed = false;
  bool fromRight = false;   ///< of stored columns
  bool fromBottom = false;  ///< of stored rows

  bool isUpright() const { return !transposed && !fromRight && !fromBottom; }
  friend bool operator==(const Orientation&, const Orientation&) = default;
};

/// The orientation of a display matrix with rows (a b u) (c d v) (x y w). The matrix maps the
/// stored point (p, q) to (a p + c q + x, b p + d q + y), y downwards (ISO/IEC 14496-12 §8.3.2).
/// Quarter turns and mirrors within a degree; upright for any other angle. Scale and offset are
/// ignored.
Orientation orientationOf(std::span<const std::int32_t, 9> displayMatrix);

/// The size of the upright image.
FrameSize oriented(FrameSize size, Orientation orientation);

/// A packed upright copy, plane by plane; chroma between two pixels may shift by one of them.
/// Preconditions: complete; grey, RGB8, RGBA8, NV12 or I420.
Image oriented(const ImageView& stored, Orientation orientation);

}  // namespace pleinair::hal::libav
