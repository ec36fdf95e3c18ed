#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>

#include "hal/clock.h"
#include "hal/image.h"

namespace pleinair::hal {

/// What `CapturedFrame::captureTime` was taken from.
enum class TimestampSource {
  kStartOfExposure,  ///< the sensor's, converted to the steady clock
  kEndOfReadout,     ///< the driver's, when the buffer was complete
  kArrival,          ///< ours, when the frame reached the process
  kRecording,        ///< the recording's own timestamp, from the first frame's time on
  kSimulated,
};

enum class FrameHealth { kValid, kCorrupt, kIncomplete };

/// A plane's dma-buf, borrowed for as long as the frame's lease is held.
struct DmaBufPlane {
  int fd = -1;  ///< −1: none
  std::size_t offsetBytes = 0;
};

/// One frame of a camera: pixels that belong to the camera, and what is known about them.
/// Copying it shares the lease. Drop every copy to give the buffer back to the driver; leases are
/// bounded, so a slow consumer copies the pixels (`Image`) and lets go.
struct CapturedFrame {
  ImageView image;                     ///< CPU view, valid while `lease` is held
  std::array<DmaBufPlane, 3> dmaBufs;  ///< set where the driver exports them
  std::uint64_t sequence = 0;          ///< counts frames the device made, from 0
  std::uint64_t droppedBefore = 0;     ///< frames lost between the last one and this
  /// Of those, how many for want of a buffer, all being leased: the consumer was too slow.
  std::uint64_t underrunsBefore = 0;
  TimePoint captureTime;  ///< on the steady clock
  TimestampSource timestampSource = TimestampSource::kArrival;
  std::optional<Duration> deviceTime;  ///< the device's own clock, where it has one
  FrameHealth health = FrameHealth::kValid;
  std::shared_ptr<const void> lease;  ///< may be dropped on any thread
};

}  // namespace pleinair::hal
