#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <variant>

#include "hal/captured_frame.h"
#include "hal/clock.h"

namespace pleinair::hal {

/// A frame of a camera that may have been lost and opened again since the previous frame. Sequence
/// and captureTime rise strictly over all sessions: sequence = the previous one + 1 +
/// frame.droppedBefore + corruptBefore + incompleteBefore + misTimedBefore, so that a ledger's sums
/// agree. Exposures between two sessions are not counted. Its health is kValid.
struct SupervisedFrame {
  CapturedFrame frame;
  /// The part of frame.droppedBefore that was lost while the camera was stalled.
  std::uint64_t lostInStall = 0;
  // Frames since the previous one that arrived but were refused:
  std::uint64_t corruptBefore = 0;     ///< health kCorrupt, or planes too small for their format
  std::uint64_t incompleteBefore = 0;  ///< health kIncomplete
  std::uint64_t misTimedBefore =
      0;  ///< a capture time that repeats, goes back, or is in the future
};

/// Counts of all frames of a supervisor. underruns is a part of dropped.
struct FrameCounts {
  std::uint64_t delivered = 0;
  std::uint64_t dropped = 0;      ///< by the device or its back end, except during stalls
  std::uint64_t underruns = 0;    ///< dropped because no buffer was free
  std::uint64_t lostInStall = 0;  ///< while the camera was stalled
  std::uint64_t corrupt = 0;
  std::uint64_t incomplete = 0;
  std::uint64_t misTimed = 0;
  LinkCounts link;  ///< packets, and no frames
  /// All frames that the camera is known to have made.
  std::uint64_t made() const {
    return delivered + dropped + lostInStall + corrupt + incomplete + misTimed;
  }
  FrameCounts operator+(const FrameCounts& other) const;
  friend bool operator==(const FrameCounts&, const FrameCounts&) = default;
};

/// The reason why a frame is refused.
enum class FrameRefusal { kCorrupt, kIncomplete, kMisTimed };

/// Numbers the frames of all sessions of a camera in one sequence and refuses invalid ones. One
/// thread.
class SessionFrames {
 public:
  /// A device's capture time may lie so far in the future, because clock conversion has an error.
  static constexpr Duration kFutureTolerance = std::chrono::milliseconds(100);

  /// Notes that a camera was opened. `isDevice`: its capture times are compared with the clock.
  void beginSession(bool isDevice) { isDevice_ = isDevice; }

  /// Gives the frame to deliver, or the reason for refusing it.
  std::variant<SupervisedFrame, FrameRefusal> take(CapturedFrame frame, TimePoint now,
                                                   bool isStalled);

  /// Includes frames dropped or refused since the last delivered one.
  FrameCounts counts() const { return counts_ + waiting_; }

 private:
  std::optional<FrameRefusal> refusalOf(const CapturedFrame& frame, TimePoint now) const;

  bool isDevice_ = true;
  std::optional<TimePoint> lastTime_;
  FrameCounts waiting_;  // since the last delivered frame
  FrameCounts counts_;
};

}  // namespace pleinair::hal
