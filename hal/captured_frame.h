#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>

#include "hal/clock.h"
#include "hal/image.h"

namespace pleinair::hal {

/// The origin of `CapturedFrame::captureTime`.
enum class TimestampSource {
  kStartOfExposure,  ///< the sensor's time, converted to the steady clock
  kEndOfReadout,     ///< the driver's time, when the buffer was complete
  kArrival,          ///< the time at which the frame reached the process
  kRecording,        ///< the recording's timestamp, counted from the first frame
  kSimulated,
};

enum class FrameHealth { kValid, kCorrupt, kIncomplete };

/// The dma-buf of one plane, borrowed while the frame's lease is held.
struct DmaBufPlane {
  int fd = -1;  ///< −1: none
  std::size_t offsetBytes = 0;
};

/// One frame of a camera: pixels that belong to the camera, and their metadata. A copy shares the
/// lease. The buffer returns to the driver when the last copy is dropped. Leases are bounded, so a
/// slow consumer copies the pixels (`Image`) and drops the frame.
struct CapturedFrame {
  ImageView image;                     ///< CPU view, valid while `lease` is held
  std::array<DmaBufPlane, 3> dmaBufs;  ///< set if the driver exports them
  std::uint64_t sequence = 0;          ///< counts frames the device made, from 0
  std::uint64_t droppedBefore = 0;     ///< frames lost between the last one and this
  /// The part of droppedBefore that was lost to buffer underruns: all buffers were leased, because
  /// the consumer was too slow.
  std::uint64_t underrunsBefore = 0;
  TimePoint captureTime;  ///< on the steady clock
  TimestampSource timestampSource = TimestampSource::kArrival;
  std::optional<Duration> deviceTime;  ///< the device's own clock, if it has one
  FrameHealth health = FrameHealth::kValid;
  std::shared_ptr<const void> lease;  ///< may be dropped on any thread
};

}  // namespace pleinair::hal
