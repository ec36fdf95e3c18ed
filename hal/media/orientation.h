#pragma once

#include <cstdint>
#include <span>

#include "hal/image.h"

namespace pleinair::hal::libav {

/// How a stored picture is to be shown: pixel (x, y) of the upright picture is the stored one of
/// column x and row y, where transposed of column y and row x; columns and rows counted from the
/// far side where it says so.
struct Orientation {
  bool transposed = false;
  bool fromRight = false;   ///< stored columns
  bool fromBottom = false;  ///< stored rows

  bool isUpright() const { return !transposed && !fromRight && !fromBottom; }
  friend bool operator==(const Orientation&, const Orientation&) = default;
};

/// Of a movie's or picture's display matrix: rows (a b u) (c d v) (x y w), which take the stored
/// point (p, q) to (a p + c q + x, b p + d q + y), y downwards (ISO/IEC 14496-12 §8.3.2). Quarter
/// turns and mirrors, within a degree; upright where it turns otherwise. Scale and offset do not
/// count.
Orientation orientationOf(std::span<const std::int32_t, 9> displayMatrix);

/// The size as shown.
FrameSize oriented(FrameSize size, Orientation orientation);

/// A packed upright copy, plane by plane: chroma between two pixels may shift by one of them.
/// Preconditions: complete; grey, RGB8, RGBA8, NV12 or I420.
Image oriented(const ImageView& stored, Orientation orientation);

}  // namespace pleinair::hal::libav
