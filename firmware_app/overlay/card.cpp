#include "firmware_app/overlay/card.h"

#include <algorithm>
#include <cstddef>

namespace pleinair::app {
namespace {

/// Calls `each` with the first byte of every pixel of the area that lies on the image.
template <class Each>
void forPixels(hal::Image& image, const CardArea& area, Each each) {
  const int right = std::min(area.x + area.width, image.size().width);
  const int bottom = std::min(area.y + area.height, image.size().height);
  for (int y = std::max(0, area.y); y < bottom; ++y) {
    const auto row = image.row(0, y);
    for (int x = std::max(0, area.x); x < right; ++x) {
      each(row.subspan(4 * static_cast<std::size_t>(x), 4), x, y);
    }
  }
}

std::uint8_t shareOf(int value, int share) {
  return static_cast<std::uint8_t>((value * share + 127) / 255);
}

}  // namespace

Card::Card(hal::FrameSize size)
    : image_({.pixelFormat = hal::PixelFormat::kRgba8,
              .size = {std::max(1, size.width), std::max(1, size.height)}}) {}

void Card::fill(const CardArea& area, const Rgb& colour, std::uint8_t alpha) {
  forPixels(image_, area, [&](std::span<std::uint8_t> px, int, int) {
    for (std::size_t c = 0; c < 3; ++c) px[c] = shareOf(colour.at(c), alpha);
    px[3] = alpha;
  });
}

void Card::ink(const hal::Image& coverage, int left, int top, const Rgb& colour) {
  const hal::ImageView view = coverage.view();
  forPixels(image_, {left, top, coverage.size().width, coverage.size().height},
            [&](std::span<std::uint8_t> px, int x, int y) {
              const int covered = view.row(0, y - top)[static_cast<std::size_t>(x - left)];
              for (std::size_t c = 0; c < 3; ++c) {
                px[c] = static_cast<std::uint8_t>(shareOf(colour.at(c), covered) +
                                                  shareOf(px[c], 255 - covered));
              }
              px[3] = static_cast<std::uint8_t>(covered + shareOf(px[3], 255 - covered));
            });
}

void Card::paste(const hal::Image& picture, int left, int top) {
  const bool hasAlpha = picture.format().pixelFormat == hal::PixelFormat::kRgba8;
  const hal::ImageView view = picture.view();
  forPixels(
      image_, {left, top, picture.size().width, picture.size().height},
      [&](std::span<std::uint8_t> px, int x, int y) {
        const auto from =
            view.row(0, y - top).subspan(static_cast<std::size_t>((x - left) * (hasAlpha ? 4 : 3)));
        std::copy_n(from.begin(), 3, px.begin());
        px[3] = 255;
      });
}

void Card::border(const CardArea& area, int px, const Rgb& colour) {
  fill({area.x, area.y, area.width, px}, colour, 255);
  fill({area.x, area.y + area.height - px, area.width, px}, colour, 255);
  fill({area.x, area.y, px, area.height}, colour, 255);
  fill({area.x + area.width - px, area.y, px, area.height}, colour, 255);
}

hal::Image inkOfText(const std::string& text, int fontPixels, int width, const char* font) {
  return hal::textCoverage(text, {.font = font,
                                  .fontPixels = std::max(1, fontPixels),
                                  .maxWidth = std::max(1, width),
                                  .tooWide = hal::TextLayout::TooWide::kWrap});
}

}  // namespace pleinair::app
