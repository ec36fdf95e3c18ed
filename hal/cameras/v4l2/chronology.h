#pragma once

#include <cstdint>
#include <optional>

#include "hal/cameras/v4l2/stream.h"
#include "hal/captured_frame.h"
#include "hal/clock.h"

namespace pleinair::hal::v4l2 {

/// Numbers and dates a device's frames so that both rise strictly, whatever its driver says.
class Chronology {
 public:
  /// The device counts anew (it was restarted); our numbers go on. What was lost meanwhile nobody
  /// knows.
  void deviceRestarted() { lastDeviceSequence_.reset(); }

  /// Sets sequence, droppedBefore, underrunsBefore, captureTime, timestampSource and deviceTime.
  ///
  /// A gap in the driver's numbers is frames lost: for want of a buffer where `wasStarving`. Its
  /// first number counts as ours 0, since some drivers count on from their last stream; a number
  /// that does not rise is taken for the next one.
  ///
  /// The driver's time holds where it is CLOCK_MONOTONIC's, rises, and lies at most 100 ms ahead:
  /// the start of the exposure where the driver says so, else the end of the read-out. Else it is
  /// `now`, as it is where the driver's lies ahead (vivid dates the end of a read-out when it
  /// begins).
  void stamp(const Filled& filled, bool wasStarving, TimePoint now, CapturedFrame& frame);

 private:
  std::optional<std::uint32_t> lastDeviceSequence_;
  std::uint64_t nextSequence_ = 0;
  std::optional<TimePoint> lastDeviceTime_;  ///< that was trusted
  std::optional<TimePoint> lastTime_;
};

}  // namespace pleinair::hal::v4l2
