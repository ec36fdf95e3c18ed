#pragma once

#include <array>
#include <chrono>
#include <cstddef>

#include "hal/clock.h"

namespace pleinair::runtime {

/// Events per second, measured over the last second. Allocates nothing.
class FrameRate {
 public:
  void count(hal::TimePoint now) {
    times_.at(next_) = now;
    next_ = (next_ + 1) % times_.size();
    if (size_ < times_.size()) ++size_;
  }
  /// Falls to 0 within two seconds after the last event.
  double perSecond(hal::TimePoint now) const {
    constexpr hal::Duration kWindow = std::chrono::seconds(1);
    constexpr hal::Duration kPatience = std::chrono::seconds(2);
    if (size_ < 2 || now - back(0) > kPatience) return 0.0;
    // Measured up to the newest event, not to now, so that a steady rate gives a steady value.
    std::size_t counted = 1;
    while (counted < size_ && back(0) - back(counted) <= kWindow) ++counted;
    if (counted < 2) counted = 2;
    const std::chrono::duration<double> span = back(0) - back(counted - 1);
    const std::chrono::duration<double> silence = now - back(0);
    const double mean = span.count() / static_cast<double>(counted - 1);
    return mean > 0.0 ? 1.0 / (silence.count() > 2 * mean ? silence.count() : mean) : 0.0;
  }

 private:
  /// The time of the event `age` events before the newest.
  hal::TimePoint back(std::size_t age) const {
    return times_.at((next_ + times_.size() - 1 - age) % times_.size());
  }

  std::array<hal::TimePoint, 256> times_{};
  std::size_t next_ = 0;
  std::size_t size_ = 0;
};

}  // namespace pleinair::runtime
