#pragma once

#include <cstdint>
#include <string>

#include "hal/image.h"

namespace pleinair::present {

/// What a waiting picture says: a title, and under it a smaller line that says more.
struct WaitingText {
  std::string title;
  std::string detail;  ///< may be empty
  friend bool operator==(const WaitingText&, const WaitingText&) = default;
};

/// A picture for a screen that has no painting to show yet, or no more: a sheet of paper, on it
/// `painting` (RGB8 or RGBA8, filling the sheet) washed out, with torn edges, and the text in the
/// margin below. Without a painting, null planes, a landscape of a few washes. RGBA8 of `size`;
/// text that would be illegible is left out. The same for the same arguments. Only the processor
/// is used. Any thread.
hal::Image waitingPicture(hal::FrameSize size, const hal::ImageView& painting,
                          const WaitingText& text);

/// Draws waiting pictures one after another, the same as waitingPicture() does, and keeps what the
/// next one may have in common: another text on a known sheet takes a fraction of the time. One
/// thread.
class WaitingPictures {
 public:
  /// `paintingNumber`: the same number stands for the same painting.
  hal::Image draw(hal::FrameSize size, const hal::ImageView& painting, std::uint64_t paintingNumber,
                  const WaitingText& text);

 private:
  hal::Image coverage_;  ///< grey: how much of the paper is painted on
  hal::Image sheet_;     ///< without a text
  std::uint64_t paintingNumber_ = 0;
};

/// An RGBA8 picture, turned clockwise by right angles.
hal::Image turned(const hal::Image& picture, int quarterTurns);
/// An RGBA8 picture with left and right exchanged.
hal::Image mirrored(const hal::Image& picture);

}  // namespace pleinair::present
