#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>

#include "hal/clock.h"
#include "hal/frame_image.h"

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

/// Packets of a camera's link, where the camera sends its frames in packets over a network.
struct LinkCounts {
  std::uint64_t missingPackets = 0;  ///< did not arrive: their frames are incomplete
  std::uint64_t resentPackets = 0;   ///< did not arrive at first, and were sent again
  std::uint64_t ignoredPackets = 0;  ///< belonged to no frame that was awaited
  LinkCounts operator+(const LinkCounts& other) const {
    return {.missingPackets = missingPackets + other.missingPackets,
            .resentPackets = resentPackets + other.resentPackets,
            .ignoredPackets = ignoredPackets + other.ignoredPackets};
  }
  friend bool operator==(const LinkCounts&, const LinkCounts&) = default;
};

/// One frame of a camera: pixels that belong to the camera, and their metadata. A copy shares the
/// lease. The buffer returns to the driver when the last copy is dropped, and the driver writes to
/// it from then on: whoever has given a GPU work that reads the dma-bufs keeps a copy of the lease
/// until the fence behind that work has signalled. Leases are bounded, so a slow consumer copies
/// the pixels (`Image`) and drops the frame.
///
/// For a GPU, the planes lie in `dmaBufs` as the pixel format's drmFourccOf() in the layout of
/// `modifier`, in the colours of `image.format.encoding`. What was imported is kept by `buffer`.
struct CapturedFrame {
  FrameImage image;  ///< its pixels are mapped on demand, while `lease` is held
  /// A smaller image (kGrey8) of the same moment and the same view, to the px, which a camera has
  /// made beside the frame for trackers: in all frames of a stream, or in none.
  std::optional<FrameImage> luma;
  std::array<DmaBufPlane, 3> dmaBufs;        ///< one an image plane, where the driver has them
  BufferIdentity buffer;                     ///< set wherever dmaBufs are
  std::uint64_t modifier = kLinearModifier;  ///< of the dma-bufs (drm_fourcc.h)
  std::uint64_t sequence = 0;                ///< counts frames the device made, from 0
  std::uint64_t droppedBefore = 0;           ///< frames lost between the last one and this
  /// The part of droppedBefore that was lost to buffer underruns: all buffers were leased, because
  /// the consumer was too slow.
  std::uint64_t underrunsBefore = 0;
  LinkCounts linkBefore;  ///< packets since the last frame
  TimePoint captureTime;  ///< on the steady clock
  TimestampSource timestampSource = TimestampSource::kArrival;
  std::optional<Duration> deviceTime;  ///< the device's own clock, if it has one
  FrameHealth health = FrameHealth::kValid;
  std::shared_ptr<const void> lease;  ///< may be dropped on any thread
};

}  // namespace pleinair::hal
