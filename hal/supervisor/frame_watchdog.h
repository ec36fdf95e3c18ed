#pragma once

#include <chrono>
#include <optional>

#include "hal/clock.h"

namespace pleinair::hal {

/// A camera that is silent for longer than periods × its frame period + margin is stalled.
struct WatchdogRule {
  int periods = 3;
  Duration margin = std::chrono::milliseconds(200);
  /// The frame period assumed for a camera that does not report one.
  Duration unknownPeriod = std::chrono::milliseconds(100);
};

/// How long a camera has been silent while somebody listened. Time in which nobody looked is not
/// the camera's: a consumer that was away, a computer that was suspended, a clock that was set
/// forward count for one look at the most.
class FrameWatchdog {
 public:
  /// A look that took longer than `longestLook` counts as that.
  FrameWatchdog(WatchdogRule rule, Duration longestLook) : rule_(rule), longestLook_(longestLook) {}

  /// The camera's frame period, from now on.
  void expect(std::optional<Duration> framePeriod);
  /// Silence begins anew.
  void frameCame(TimePoint now);
  /// Nothing usable came until now.
  void nothingCame(TimePoint now);

  Duration silence() const { return silence_; }
  Duration limit() const { return limit_; }
  bool isBeyondLimit() const { return silence_ > limit_; }

 private:
  WatchdogRule rule_;
  Duration longestLook_;
  Duration limit_{};
  Duration silence_{};
  TimePoint lastLook_;
};

}  // namespace pleinair::hal
