#include "pipeline/present/caption_picture.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>

#include "hal/text/text_coverage.h"

namespace pleinair::present {
namespace {

/// Of the picture's shorter side.
constexpr int kLinesHigh = 38;
constexpr int kMinFontPixels = 11;
constexpr int kMaxFontPixels = 64;
/// Of the letters' size.
constexpr double kMargin = 0.8;
constexpr double kPadding = 0.5;
/// A window's band lies over a desktop's letters; these stand farther off.
constexpr unsigned kBandAlpha = 160;

int part(double factor, int fontPixels) {
  return std::max(1, static_cast<int>(factor * fontPixels));
}

/// White, where `coverage` is, on black of kBandAlpha.
void drawText(hal::Image& band, const hal::ImageView& coverage, int padding) {
  for (std::size_t i = 3; i < band.plane(0).size(); i += 4) band.plane(0)[i] = kBandAlpha;
  const int rows = std::min(coverage.format.size.height, band.size().height - 2 * padding);
  const int columns = std::min(coverage.format.size.width, band.size().width - 2 * padding);
  for (int y = 0; y < rows; ++y) {
    const std::span<const std::uint8_t> from = coverage.row(0, y);
    const std::span<std::uint8_t> to = band.row(0, y + padding);
    for (int x = 0; x < columns; ++x) {
      const unsigned ink = from[static_cast<std::size_t>(x)];
      const unsigned alpha = ink + kBandAlpha * (255 - ink) / 255;
      const auto level = static_cast<std::uint8_t>(255 * ink / std::max(1U, alpha));
      const std::size_t at = 4 * static_cast<std::size_t>(x + padding);
      to[at] = to[at + 1] = to[at + 2] = level;
      to[at + 3] = static_cast<std::uint8_t>(alpha);
    }
  }
}

}  // namespace

CaptionPicture captionPicture(const std::string& text, hal::FrameSize size) {
  int fontPixels =
      std::clamp(std::min(size.width, size.height) / kLinesHigh, kMinFontPixels, kMaxFontPixels);
  if (text.empty()) return {};
  for (;;) {
    const int margin = part(kMargin, fontPixels);
    const int padding = part(kPadding, fontPixels);
    const int widest = size.width - 2 * (margin + padding);
    const int highest = size.height - 2 * (margin + padding);
    if (widest < fontPixels || highest < fontPixels) return {};
    const hal::Image coverage = hal::textCoverage(
        text,
        {.fontPixels = fontPixels, .maxWidth = widest, .tooWide = hal::TextLayout::TooWide::kWrap});
    if (coverage.size().height > highest && fontPixels > kMinFontPixels) {
      fontPixels = std::max(kMinFontPixels, fontPixels * 7 / 8);
      continue;
    }
    const hal::FrameSize band{std::min(coverage.size().width, widest) + 2 * padding,
                              std::min(coverage.size().height, highest) + 2 * padding};
    CaptionPicture caption{
        .image =
            hal::Image({.pixelFormat = hal::PixelFormat::kRgba8, .size = band, .encoding = {}}),
        .left = margin,
        .top = margin};
    drawText(caption.image, coverage.view(), padding);
    return caption;
  }
}

}  // namespace pleinair::present
