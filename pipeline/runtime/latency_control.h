#pragma once

#include <chrono>
#include <cstdint>

#include "hal/clock.h"
#include "pipeline/runtime/duration_histogram.h"

namespace pleinair::runtime {

struct LatencyRules {
  hal::Duration configured = std::chrono::milliseconds(120);
  hal::Duration maximum = std::chrono::milliseconds(400);  ///< at least `configured`
  hal::Duration step = std::chrono::microseconds(16'667);  ///< a refresh
  hal::Duration raiseAfter = std::chrono::seconds(1);
  hal::Duration lowerAfter = std::chrono::seconds(5);
};

/// How long after its capture a frame is shown. It stays where it was configured while there is any
/// other way; where the lowest quality misses it for a second, it rises by as many refreshes as
/// were missing, and goes back by one at a time once there is room to spare. One thread.
class LatencyControl {
 public:
  explicit LatencyControl(LatencyRules rules);

  hal::Duration latency() const { return latency_; }
  std::uint64_t raised() const { return raised_; }    ///< how often so far
  std::uint64_t lowered() const { return lowered_; }  ///< likewise

  /// A picture was ready at `now`, so long before captured + latency() (negative: after).
  /// `isLowestQuality`: nothing else is left to be done about it. True if the latency changes.
  bool ready(hal::Duration slack, bool isLowestQuality, hal::TimePoint now);

 private:
  void beginWindow(hal::TimePoint now);
  bool raise(hal::TimePoint now);
  bool lower(hal::TimePoint now);

  LatencyRules rules_;
  hal::Duration latency_;
  std::uint64_t raised_ = 0;
  std::uint64_t lowered_ = 0;

  // Counts of the last second:
  hal::TimePoint windowBegan_;
  bool hasWindow_ = false;
  bool wasLowest_ = false;
  std::uint64_t pictures_ = 0;
  DurationHistogram lateness_;  ///< of the late ones

  hal::TimePoint roomSince_;  ///< since when all had room for a step less
};

}  // namespace pleinair::runtime
