#include "hal/supervisor/frame_watchdog.h"

#include <algorithm>

namespace pleinair::hal {

void FrameWatchdog::expect(std::optional<Duration> framePeriod) {
  limit_ = rule_.periods * framePeriod.value_or(rule_.unknownPeriod) + rule_.margin;
}

void FrameWatchdog::frameCame(TimePoint now) {
  silence_ = Duration::zero();
  lastPoll_ = now;
}

void FrameWatchdog::nothingCame(TimePoint now) {
  silence_ += std::clamp(now - lastPoll_, Duration::zero(), maxPollInterval_);
  lastPoll_ = now;
}

}  // namespace pleinair::hal
