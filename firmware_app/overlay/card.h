#pragma once

#include <array>
#include <cstdint>
#include <string>

#include "hal/image.h"
#include "hal/text/text_coverage.h"

namespace pleinair::app {

using Rgb = std::array<std::uint8_t, 3>;

/// A rectangle of a card: from (x, y), in pixels.
struct CardArea {
  int x = 0;
  int y = 0;
  int width = 0;
  int height = 0;
};

/// A picture to be laid over others: text and colours, RGBA8 with premultiplied alpha. What lies
/// beside it is left out.
class Card {
 public:
  /// Transparent.
  explicit Card(hal::FrameSize size);

  hal::FrameSize size() const { return image_.size(); }
  const hal::Image& image() const { return image_; }
  hal::Image take() { return std::move(image_); }

  /// `alpha`: 0 … 255; replaces what is there.
  void fill(const CardArea& area, const Rgb& colour, std::uint8_t alpha);
  /// Ink where a grey picture is not 0, over what is there.
  void ink(const hal::Image& coverage, int x, int y, const Rgb& colour);
  /// An opaque RGB8 or RGBA8 picture.
  void paste(const hal::Image& picture, int x, int y);
  /// A frame within the area.
  void border(const CardArea& area, int px, const Rgb& colour);

 private:
  hal::Image image_;
};

/// Text as coverage, wrapped at `width`.
hal::Image inkOfText(const std::string& text, int fontPixels, int width, const char* font = "Sans");

}  // namespace pleinair::app
