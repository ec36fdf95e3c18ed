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

/// Measures how long a camera has been silent while it was polled. Time without polling does not
/// count: a busy consumer, a suspended computer and a jump of the clock count for at most one poll.
class FrameWatchdog {
 public:
  /// The time since the previous poll counts for at most `maxPollInterval`.
  FrameWatchdog(WatchdogRule rule, Duration maxPollInterval)
      : rule_(rule), maxPollInterval_(maxPollInterval) {}

  /// Sets the camera's frame period, from which the limit follows.
  void expect(std::optional<Duration> framePeriod);
  /// Notes a usable frame, which ends the silence.
  void frameCame(TimePoint now);
  /// Notes that no usable frame has come until `now`.
  void nothingCame(TimePoint now);

  Duration silence() const { return silence_; }
  Duration limit() const { return limit_; }
  bool isBeyondLimit() const { return silence_ > limit_; }

 private:
  WatchdogRule rule_;
  Duration maxPollInterval_;
  Duration limit_{};
  Duration silence_{};
  TimePoint lastPoll_;
};

}  // namespace pleinair::hal
