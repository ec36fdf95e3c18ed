#pragma once

#include <cstdint>
#include <optional>

#include "hal/clock.h"

namespace pleinair::hal::recording {

/// Turns a recording's timestamps into times since its first frame that rise strictly. Sound ones
/// come through exactly; the others are fixed:
/// - missing: one period (and one for each frame left out) after the last;
/// - not after the last by up to a second: half a period after the last, so that the next sound one
///   is in time again;
/// - a jump back by more, or on by more than a day: the clock was set; goes on one period later.
class Timeline {
 public:
  explicit Timeline(Duration nominalPeriod) : period_(nominalPeriod) {}

  Duration place(std::optional<Duration> time, std::uint64_t droppedBefore);

  /// The recording starts over: the next frame comes one period after the last.
  void startOver();

  std::uint64_t mendedCount() const { return mended_; }

 private:
  Duration period_;
  std::optional<Duration> last_;    ///< of our times
  std::optional<Duration> origin_;  ///< the recording's time where ours is zero
  std::uint64_t mended_ = 0;
};

}  // namespace pleinair::hal::recording
