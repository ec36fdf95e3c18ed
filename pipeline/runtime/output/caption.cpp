#include "pipeline/runtime/output/caption.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <span>

namespace pleinair::runtime {
namespace {

constexpr std::size_t kCaptionPixelBytes = 4;
constexpr unsigned kOpaque = 256;

/// The part of a frame's row that lies under a caption.
std::span<std::uint8_t> rowUnder(hal::Image& frame, const Caption& caption, int y) {
  return frame.row(0, caption.top + y)
      .subspan(kCaptionPixelBytes * static_cast<std::size_t>(caption.left),
               kCaptionPixelBytes * static_cast<std::size_t>(caption.image.size().width));
}

void blendOver(std::span<std::uint8_t> row, std::span<const std::uint8_t> over, unsigned opacity) {
  for (std::size_t i = 0; i < row.size(); i += kCaptionPixelBytes) {
    const unsigned alpha = over[i + 3] * opacity / kOpaque;
    for (std::size_t c = 0; c + 1 < kCaptionPixelBytes; ++c) {
      const unsigned mixed = over[i + c] * alpha + row[i + c] * (255 - alpha) + 127;
      row[i + c] = static_cast<std::uint8_t>(mixed / 255);
    }
  }
}

}  // namespace

bool CaptionOverlay::draw(hal::Image& frame, const Caption& caption, double opacity) {
  if (frame.format() != caption.frame) return false;
  const hal::FrameSize size = caption.image.size();
  assert(caption.left >= 0 && caption.left + size.width <= frame.size().width);
  assert(caption.top >= 0 && caption.top + size.height <= frame.size().height);
  const auto part = static_cast<unsigned>(std::lround(kOpaque * std::clamp(opacity, 0.0, 1.0)));
  const hal::ImageView over = caption.image.view();
  covered_.clear();
  for (int y = 0; y < size.height; ++y) {
    const std::span<std::uint8_t> row = rowUnder(frame, caption, y);
    covered_.insert(covered_.end(), row.begin(), row.end());
    blendOver(row, over.row(0, y), part);
  }
  return true;
}

void CaptionOverlay::remove(hal::Image& frame, const Caption& caption) const {
  std::span<const std::uint8_t> left(covered_);
  for (int y = 0; y < caption.image.size().height; ++y) {
    const std::span<std::uint8_t> row = rowUnder(frame, caption, y);
    std::ranges::copy(left.first(row.size()), row.begin());
    left = left.subspan(row.size());
  }
}

}  // namespace pleinair::runtime
