#pragma once

#include <chrono>
#include <optional>

#include "hal/clock.h"

namespace pleinair::app {

/// How much of a caption is to be seen: all of it for three seconds after it was last called up,
/// then less for half a second.
class Fading {
 public:
  static constexpr hal::Duration kStays = std::chrono::seconds(3);
  static constexpr hal::Duration kFades = std::chrono::milliseconds(500);

  void callUp(hal::TimePoint now) { calledUp_ = now; }
  /// From 0 to 1.
  double opacity(hal::TimePoint now) const {
    if (!calledUp_) return 0.0;
    const std::chrono::duration<double> faded = now - *calledUp_ - kStays;
    if (faded.count() <= 0.0) return 1.0;
    const double left = 1.0 - faded / std::chrono::duration<double>(kFades);
    return left > 0.0 ? left : 0.0;
  }

 private:
  std::optional<hal::TimePoint> calledUp_;
};

}  // namespace pleinair::app
