#pragma once

#include <chrono>
#include <mutex>
#include <stop_token>
#include <string>

namespace pleinair::hal {

using Duration = std::chrono::nanoseconds;

/// The time base of every frame: monotonic, with an arbitrary origin. On a live system it is
/// CLOCK_MONOTONIC; under a SteppedClock the test or the recording sets it.
struct MonotonicTime {
  using duration = Duration;
  using rep = duration::rep;
  using period = duration::period;
  using time_point = std::chrono::time_point<MonotonicTime, Duration>;
  static constexpr bool is_steady = true;  // NOLINT(readability-identifier-naming): the standard's
};
using TimePoint = MonotonicTime::time_point;

/// A deadline that never comes.
inline constexpr TimePoint kNoDeadline = TimePoint::max();

/// The source of time. It is injected everywhere, so that no test sleeps. Thread-safe.
class Clock {
 public:
  virtual ~Clock() = default;
  virtual TimePoint now() const = 0;
  /// Returns true at `time` (at once if it has passed), or false early when a stop is requested.
  virtual bool sleepUntil(TimePoint time, std::stop_token stop = {}) = 0;
};

/// CLOCK_MONOTONIC.
class SteadyClock final : public Clock {
 public:
  TimePoint now() const override;
  bool sleepUntil(TimePoint time, std::stop_token stop = {}) override;
};

/// One SteadyClock for all, which need not keep it alive.
const Clock& steadyClock();

/// Simulated time: a sleeper jumps to its wake-up time without waiting.
class SteppedClock final : public Clock {
 public:
  explicit SteppedClock(TimePoint start = TimePoint{}) : now_(start) {}
  TimePoint now() const override;
  bool sleepUntil(TimePoint time, std::stop_token stop = {}) override;
  void advance(Duration by);

 private:
  mutable std::mutex mutex_;
  TimePoint now_;
};

/// When a recorded or simulated camera delivers its frames.
enum class Pacing {
  kStepped,   ///< each frame at once: offline rendering
  kRealTime,  ///< each frame at its capture time by the clock
};

/// A duration as a number, for formulas and reports.
constexpr double toSeconds(Duration duration) {
  return std::chrono::duration<double>(duration).count();
}
constexpr double toMilliseconds(Duration duration) {
  return std::chrono::duration<double, std::milli>(duration).count();
}
/// Rounded to the nearest nanosecond. Precondition: at most 292 years.
constexpr Duration fromSeconds(double seconds) {
  return std::chrono::round<Duration>(std::chrono::duration<double>(seconds));
}
constexpr Duration fromMilliseconds(double milliseconds) {
  return std::chrono::round<Duration>(std::chrono::duration<double, std::milli>(milliseconds));
}

/// For a person: "310 ms" below a second, else "3.3 s".
std::string durationText(Duration duration);

}  // namespace pleinair::hal
