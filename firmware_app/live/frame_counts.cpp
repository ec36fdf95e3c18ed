#include "firmware_app/live/frame_counts.h"

#include <chrono>
#include <numeric>
#include <string_view>

#include <fmt/format.h>

namespace pleinair::app {
namespace {

// In the order of DropReason.
constexpr std::array<std::string_view, 4> kNames{
    "left out by the camera", "replaced by a newer one", "while paused", "unfinished at the end"};

}  // namespace

void FrameCounts::drop(DropReason reason, std::uint64_t count) {
  dropped_.at(static_cast<std::size_t>(reason)) += count;
}

std::uint64_t FrameCounts::dropped(DropReason reason) const {
  return dropped_.at(static_cast<std::size_t>(reason));
}

std::uint64_t FrameCounts::dropped() const {
  return std::accumulate(dropped_.begin(), dropped_.end(), std::uint64_t{0});
}

std::string FrameCounts::summary(hal::Duration elapsed) const {
  const double seconds = std::chrono::duration<double>(elapsed).count();
  const double rate = seconds > 0.0 ? static_cast<double>(shown_) / seconds : 0.0;
  std::string text = fmt::format("showed {} {} in {:.1f} s ({:.1f} frames/s); dropped {}", shown_,
                                 shown_ == 1 ? "frame" : "frames", seconds, rate, dropped());
  const char* separator = ": ";
  for (std::size_t i = 0; i < kReasons; ++i) {
    if (dropped_.at(i) == 0) continue;
    text += fmt::format("{}{} {}", separator, dropped_.at(i), kNames.at(i));
    separator = ", ";
  }
  return text;
}

}  // namespace pleinair::app
