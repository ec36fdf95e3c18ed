#pragma once

#include <cstdint>
#include <span>

#include "hal/pixel_format.h"

namespace pleinair::tracking {

/// A cell of the grid that a camera image is segmented on.
struct SegmentCell {
  /// The segment's label, 1 to kMaxSegmentLabel, or 0 where the image is too small-scaled or too
  /// soft to say. A segment keeps its label from frame to frame.
  std::uint16_t label = 0;
  /// Whether all cells up to two steps away have the same label.
  bool isInside = false;
  /// The segment's mean colour near the cell, without cells that its border crosses: luma and
  /// chroma (BT.601, full range; chroma about 128) in 8-bit levels.
  std::uint8_t luma = 0;
  std::uint8_t cb = 128;
  std::uint8_t cr = 128;
  friend bool operator==(const SegmentCell&, const SegmentCell&) = default;
};

inline constexpr std::uint16_t kMaxSegmentLabel = 4095;

/// Segments of a camera image: its parts between clear borders of colour. Refers to a segmenter's
/// buffers and is valid until that takes the next frame.
struct ImageSegments {
  hal::FrameSize frameSize;
  hal::FrameSize grid;                 ///< cells across and down; they cover the frame evenly
  std::span<const SegmentCell> cells;  ///< row by row
};

}  // namespace pleinair::tracking
