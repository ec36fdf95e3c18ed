#pragma once

#include <cstdint>
#include <optional>

#include "hal/cameras/v4l2/stream.h"
#include "hal/captured_frame.h"
#include "hal/clock.h"

namespace pleinair::hal::v4l2 {

/// Assigns strictly rising sequence numbers and capture times to a device's frames, even if the
/// driver's own are wrong.
class Chronology {
 public:
  /// The device was restarted and counts from the start; the sequence numbers go on. Frames lost
  /// during the restart are not counted.
  void deviceRestarted() { lastDeviceSequence_.reset(); }

  /// Sets sequence, droppedBefore, underrunsBefore, captureTime, timestampSource and deviceTime.
  ///
  /// A gap in the driver's numbers counts as dropped frames, and as buffer underruns if
  /// `wasStarving`. The driver's first number becomes 0, since some drivers count on from their
  /// previous stream. A number that does not rise counts as the next one.
  ///
  /// The driver's timestamp is used if it is CLOCK_MONOTONIC's, rises, and lies at most 100 ms
  /// ahead: the start of the exposure if the driver gives that, else the end of the read-out.
  /// Otherwise, and if it lies ahead of `now`, captureTime is `now` (vivid gives the time of a
  /// read-out's end when the read-out begins).
  void stamp(const Filled& filled, bool wasStarving, TimePoint now, CapturedFrame& frame);

 private:
  std::optional<std::uint32_t> lastDeviceSequence_;
  std::uint64_t nextSequence_ = 0;
  std::optional<TimePoint> lastDeviceTime_;  ///< the last one that was used
  std::optional<TimePoint> lastTime_;
};

}  // namespace pleinair::hal::v4l2
