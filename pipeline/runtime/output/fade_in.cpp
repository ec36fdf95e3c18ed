#include "pipeline/runtime/output/fade_in.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>

namespace pleinair::runtime {
namespace {

/// What the first frame counts as: a fade that began with nothing of it would show it one frame
/// late.
constexpr hal::Duration kLead = std::chrono::milliseconds(70);
constexpr unsigned kWhole = 256;

/// In 1/256, rising evenly at first and at last.
unsigned opacityAfter(hal::Duration passed) {
  const double t =
      std::clamp(hal::toSeconds(passed + kLead) / hal::toSeconds(FadeIn::kDuration), 0.0, 1.0);
  return static_cast<unsigned>(std::lround(kWhole * t * t * (3.0 - 2.0 * t)));
}

/// Two of a pixel's channels at once, each in 16 bits.
constexpr std::uint32_t kLanes = 0x00FF00FF;
constexpr std::uint32_t kHalf = 0x00800080;

std::uint32_t blended(std::uint32_t above, std::uint32_t below, unsigned opacity) {
  const unsigned rest = kWhole - opacity;
  const std::uint32_t even = (above & kLanes) * opacity + (below & kLanes) * rest + kHalf;
  const std::uint32_t odd =
      ((above >> 8U) & kLanes) * opacity + ((below >> 8U) & kLanes) * rest + kHalf;
  return ((even >> 8U) & kLanes) | (odd & ~kLanes);
}

void blend(hal::Image& frame, const hal::ImageView& from, unsigned opacity) {
  constexpr std::size_t kPixelBytes = 4;
  for (int y = 0; y < frame.size().height; ++y) {
    const std::span<std::uint8_t> row = frame.row(0, y);
    const std::span<const std::uint8_t> below = from.row(0, y);
    for (std::size_t i = 0; i + kPixelBytes <= row.size(); i += kPixelBytes) {
      std::uint32_t pixel = 0;
      std::uint32_t under = 0;
      std::memcpy(&pixel, &row[i], kPixelBytes);
      std::memcpy(&under, &below[i], kPixelBytes);
      pixel = blended(pixel, under, opacity);
      std::memcpy(&row[i], &pixel, kPixelBytes);
    }
  }
}

}  // namespace

bool FadeIn::apply(hal::Image& frame, hal::TimePoint due) {
  if (!isOn()) return true;
  if (!firstDue_) firstDue_ = due;
  const unsigned opacity = opacityAfter(due - *firstDue_);
  if (opacity == kWhole || frame.format() != from_->format()) {
    end();
    return true;
  }
  blend(frame, from_->view(), opacity);
  return false;
}

}  // namespace pleinair::runtime
