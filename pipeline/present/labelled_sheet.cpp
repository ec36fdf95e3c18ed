#include "pipeline/present/labelled_sheet.h"

#include <algorithm>
#include <cassert>
#include <cstdint>

#include "hal/text/text_coverage.h"

namespace pleinair::present {
namespace {

constexpr int kSheetGapPx = 12;
constexpr int kLabelPx = 15;     ///< of its font
constexpr int kLabelRowPx = 24;  ///< what a label takes below its image
constexpr int kLabelAbovePx = 2;

/// Copies `image` so that its first pixel is at (x, y) of the sheet.
void copyTo(hal::Image& sheet, const hal::ImageView& image, int x, int y) {
  for (int row = 0; row < image.format.size.height; ++row) {
    const auto from = image.row(0, row);
    const auto to = sheet.row(0, y + row).subspan(3 * static_cast<std::size_t>(x), from.size());
    std::ranges::copy(from, to.begin());
  }
}

/// Black ink on white.
void writeLabel(hal::Image& sheet, const std::string& text, int x, int y, int maxWidth) {
  const hal::Image ink =
      hal::textCoverage(text, {.fontPixels = kLabelPx, .maxWidth = std::max(1, maxWidth)});
  const hal::FrameSize size = ink.size();
  for (int row = 0; row < std::min(size.height, kLabelRowPx - kLabelAbovePx); ++row) {
    const auto coverage = ink.view().row(0, row);
    const auto to = sheet.row(0, y + row).subspan(3 * static_cast<std::size_t>(x));
    for (std::size_t i = 0; i < coverage.size() && 3 * i + 2 < to.size(); ++i) {
      const auto white = static_cast<std::uint8_t>(255 - coverage[i]);
      std::fill_n(to.begin() + static_cast<std::ptrdiff_t>(3 * i), 3, white);
    }
  }
}

}  // namespace

hal::Image labelledSheet(std::span<const LabelledImage> images, int columns) {
  assert(!images.empty() && columns >= 1);
  const hal::FrameSize tile = images.front().image.size();
  const int count = static_cast<int>(images.size());
  const int across = std::min(columns, count);
  const int rows = (count + columns - 1) / columns;
  const int stepX = tile.width + kSheetGapPx;
  const int stepY = tile.height + kLabelRowPx + kSheetGapPx;
  hal::Image sheet({.pixelFormat = hal::PixelFormat::kRgb8,
                    .size = {kSheetGapPx + across * stepX, kSheetGapPx + rows * stepY}});
  std::ranges::fill(sheet.plane(0), std::uint8_t{255});
  for (int i = 0; i < count; ++i) {
    const LabelledImage& each = images[static_cast<std::size_t>(i)];
    assert(each.image.size() == tile);
    const int x = kSheetGapPx + (i % columns) * stepX;
    const int y = kSheetGapPx + (i / columns) * stepY;
    copyTo(sheet, each.image.view(), x, y);
    writeLabel(sheet, each.label, x, y + tile.height + kLabelAbovePx, tile.width);
  }
  return sheet;
}

}  // namespace pleinair::present
