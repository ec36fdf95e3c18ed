#pragma once

#include <cstdint>
#include <vector>

#include "hal/image.h"

namespace pleinair::runtime {

/// A picture over the frames of an output, such as text about a key that was pressed.
struct Caption {
  hal::Image image;  ///< RGBA8, its alpha not multiplied in
  int left = 0;      ///< px, in frames as the output takes them; it lies within them
  int top = 0;
  hal::FrameFormat frame;  ///< RGBA8; lies over no other frames
};

/// Draws captions over frames, and takes them off again. One thread.
class CaptionOverlay {
 public:
  /// `opacity`: from 0 to 1, multiplies that of the caption. Returns false, and draws nothing,
  /// where the frame is not of the caption's format. Allocates where a caption is larger than all
  /// before it.
  bool draw(hal::Image& frame, const Caption& caption, double opacity);
  /// Gives the frame, which draw() has drawn over, the pixels that it had before, to the bit.
  void remove(hal::Image& frame, const Caption& caption) const;

 private:
  std::vector<std::uint8_t> covered_;  ///< rows of the frame, under the caption
};

}  // namespace pleinair::runtime
