#pragma once

#include <cstdint>
#include <optional>

#include "hal/clock.h"

namespace pleinair::hal::recording {

/// Converts a recording's timestamps to strictly rising times since its first frame. Valid
/// timestamps are kept exactly; the others are corrected:
/// - missing: one period after the last time, plus one for each skipped frame;
/// - up to a second before the last time, or equal to it: half a period after the last time, so
///   that the next valid timestamp fits again;
/// - a larger jump back, or a jump of more than a day forward: the clock was set. Time goes on one
///   period after the last time.
class Timeline {
 public:
  explicit Timeline(Duration nominalPeriod) : period_(nominalPeriod) {}

  Duration place(std::optional<Duration> time, std::uint64_t droppedBefore);

  /// The recording starts over: the next frame comes one period after the last.
  void startOver();

  std::uint64_t correctedCount() const { return corrected_; }

 private:
  Duration period_;
  std::optional<Duration> last_;    ///< in output time
  std::optional<Duration> origin_;  ///< the recording's timestamp at output time zero
  std::uint64_t corrected_ = 0;
};

}  // namespace pleinair::hal::recording
