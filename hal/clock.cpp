#include "hal/clock.h"

#include <algorithm>
#include <chrono>
#include <condition_variable>

namespace pleinair::hal {

const Clock& steadyClock() {
  static const SteadyClock clock;
  return clock;
}

TimePoint SteadyClock::now() const {
  return TimePoint(
      std::chrono::duration_cast<Duration>(std::chrono::steady_clock::now().time_since_epoch()));
}

bool SteadyClock::sleepUntil(TimePoint time, std::stop_token stop) {
  std::mutex mutex;
  std::condition_variable_any wake;
  std::unique_lock lock(mutex);
  const std::chrono::steady_clock::time_point until(time.time_since_epoch());
  wake.wait_until(lock, stop, until, [] { return false; });
  return !stop.stop_requested();
}

TimePoint SteppedClock::now() const {
  const std::scoped_lock lock(mutex_);
  return now_;
}

bool SteppedClock::sleepUntil(TimePoint time, std::stop_token stop) {
  if (stop.stop_requested()) return false;
  const std::scoped_lock lock(mutex_);
  now_ = std::max(now_, time);
  return true;
}

void SteppedClock::advance(Duration by) {
  const std::scoped_lock lock(mutex_);
  now_ += by;
}

std::string durationText(Duration duration) {
  const auto milliseconds = std::chrono::round<std::chrono::milliseconds>(duration).count();
  if (milliseconds < 1000) return std::to_string(milliseconds) + " ms";
  const auto tenths = (milliseconds + 50) / 100;
  return std::to_string(tenths / 10) + "." + std::to_string(tenths % 10) + " s";
}

}  // namespace pleinair::hal
