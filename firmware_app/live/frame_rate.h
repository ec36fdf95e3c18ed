#pragma once

#include <chrono>
#include <deque>

#include "hal/clock.h"

namespace pleinair::app {

/// Frames a second over the last second or so.
class FrameRate {
 public:
  void count(hal::TimePoint now) {
    constexpr hal::Duration kWindow = std::chrono::seconds(1);
    times_.push_back(now);
    while (now - times_.front() > kWindow) times_.pop_front();
  }
  double perSecond() const {
    if (times_.size() < 2) return 0.0;
    const std::chrono::duration<double> span = times_.back() - times_.front();
    return span.count() > 0.0 ? static_cast<double>(times_.size() - 1) / span.count() : 0.0;
  }

 private:
  std::deque<hal::TimePoint> times_;
};

}  // namespace pleinair::app
