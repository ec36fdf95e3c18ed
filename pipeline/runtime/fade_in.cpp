#include "pipeline/runtime/fade_in.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
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

void blend(hal::Image& frame, const hal::ImageView& from, unsigned opacity) {
  for (int y = 0; y < frame.size().height; ++y) {
    const std::span<std::uint8_t> row = frame.row(0, y);
    const std::span<const std::uint8_t> below = from.row(0, y);
    for (std::size_t i = 0; i < row.size(); ++i) {
      const unsigned sum = row[i] * opacity + below[i] * (kWhole - opacity);
      row[i] = static_cast<std::uint8_t>((sum + kWhole / 2) / kWhole);
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
