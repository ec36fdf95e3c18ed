#pragma once

#include <cstdint>
#include <optional>

#include "hal/cameras/aravis/library.h"
#include "hal/captured_frame.h"
#include "hal/clock.h"

namespace pleinair::hal::aravis {

/// Assigns strictly rising sequence numbers and capture times to the frames of one stream, and says
/// what was lost between them and why.
class FrameNumbers {
 public:
  explicit FrameNumbers(Transport transport) : transport_(transport) {}

  /// Sets sequence, droppedBefore, underrunsBefore, linkBefore, captureTime, timestampSource and
  /// deviceTime.
  ///
  /// A gap in the device's numbers counts as dropped frames, as far as Aravis counted underruns as
  /// buffer underruns. GigE Vision's numbers have 16 bits and go from 65535 to 1 (GigE Vision 2
  /// also has 64 bits); a number that does not rise counts as the next one. The first number
  /// becomes 0.
  ///
  /// The capture time is the arrival of the frame's first packet, which a camera sends when the
  /// exposure is over: the device's clock is not the computer's, and neither it nor Aravis' own
  /// time, which is the wall clock's, rises in every case.
  void stamp(const Filled& filled, const StreamCounts& counts, TimePoint now, CapturedFrame& frame);

 private:
  std::uint64_t lostSince(std::uint64_t frameId) const;

  Transport transport_;
  std::optional<std::uint64_t> lastId_;
  std::uint64_t nextSequence_ = 0;
  std::uint64_t underrunsToTell_ = 0;
  StreamCounts counted_;
  std::optional<TimePoint> lastTime_;
};

}  // namespace pleinair::hal::aravis
