#pragma once

#include <chrono>
#include <cstdint>

#include "hal/clock.h"
#include "pipeline/runtime/duration_histogram.h"

namespace pleinair::runtime {

struct LatencyRules {
  hal::Duration configured = std::chrono::milliseconds(120);
  hal::Duration maximum = std::chrono::milliseconds(400);  ///< at least `configured`
  hal::Duration step = std::chrono::microseconds(16'667);  ///< one refresh period
  hal::Duration raiseAfter = std::chrono::seconds(1);
  hal::Duration lowerAfter = std::chrono::seconds(5);
};

/// The latency in force. It is the configured one as long as some quality level meets it. If the
/// lowest level misses it for a second, it rises by as many refreshes as most late frames lacked;
/// it falls by one refresh at a time once all frames have been early enough. One thread.
class LatencyControl {
 public:
  explicit LatencyControl(LatencyRules rules);

  hal::Duration latency() const { return latency_; }
  std::uint64_t raised() const { return raised_; }    ///< number of rises so far
  std::uint64_t lowered() const { return lowered_; }  ///< number of falls so far

  /// Notes a frame that was ready at `now`, `slack` before captured + latency() (negative: after).
  /// `isLowestQuality`: quality cannot be lowered further. Returns whether the latency changes.
  bool ready(hal::Duration slack, bool isLowestQuality, hal::TimePoint now);

 private:
  void beginWindow(hal::TimePoint now);
  bool raise(hal::TimePoint now);
  bool lower(hal::TimePoint now);

  LatencyRules rules_;
  hal::Duration latency_;
  std::uint64_t raised_ = 0;
  std::uint64_t lowered_ = 0;

  // Counts since windowBegan_, for up to a second:
  hal::TimePoint windowBegan_;
  bool hasWindow_ = false;
  bool wasLowest_ = false;
  std::uint64_t frames_ = 0;
  DurationHistogram lateness_;  ///< of the late frames

  hal::TimePoint roomSince_;  ///< since then each frame would have met the latency of a step less
};

}  // namespace pleinair::runtime
