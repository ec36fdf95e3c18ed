#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <variant>

#include "hal/captured_frame.h"
#include "hal/clock.h"

namespace pleinair::hal {

/// A frame of a camera that may have been lost and opened anew since the last one. Its sequence and
/// captureTime rise strictly over all sessions: sequence = the last one's + 1 + frame.droppedBefore
/// + corruptBefore + incompleteBefore + misTimedBefore, so that a ledger's sums agree. Frames that
/// nobody knows of, between two sessions, are not in it. Its health is kValid.
struct SupervisedFrame {
  CapturedFrame frame;
  /// The part of frame.droppedBefore that was lost while the camera was stalled.
  std::uint64_t lostInStall = 0;
  // Frames since the last one that came, but could not be let out:
  std::uint64_t corruptBefore = 0;     ///< health kCorrupt, or planes too small for their format
  std::uint64_t incompleteBefore = 0;  ///< health kIncomplete
  std::uint64_t misTimedBefore =
      0;  ///< a capture time that repeats, goes back, or is in the future
};

/// All of a supervisor's frames. made() = the sum of the others.
struct FrameCounts {
  std::uint64_t delivered = 0;
  std::uint64_t dropped = 0;      ///< by the device or its back end, stalls apart; of those …
  std::uint64_t underruns = 0;    ///< … for want of a free buffer
  std::uint64_t lostInStall = 0;  ///< while the camera was stalled
  std::uint64_t corrupt = 0;
  std::uint64_t incomplete = 0;
  std::uint64_t misTimed = 0;
  std::uint64_t made() const {
    return delivered + dropped + lostInStall + corrupt + incomplete + misTimed;
  }
  FrameCounts operator+(const FrameCounts& other) const;
  friend bool operator==(const FrameCounts&, const FrameCounts&) = default;
};

/// Why a frame is not let out.
enum class FrameRefusal { kCorrupt, kIncomplete, kMisTimed };

/// Numbers the frames of all sessions of a camera in one sequence and keeps back those that are not
/// what they say. One thread.
class SessionFrames {
 public:
  /// How far in the future a device's capture time may lie: its clock is converted with an error.
  static constexpr Duration kFutureTolerance = std::chrono::milliseconds(100);

  /// A camera was opened. `isDevice`: its times are held against the clock.
  void beginSession(bool isDevice) { isDevice_ = isDevice; }

  /// The frame as it may go out, or why not.
  std::variant<SupervisedFrame, FrameRefusal> take(CapturedFrame frame, TimePoint now,
                                                   bool isStalled);

  /// With those that came after the last frame that went out.
  FrameCounts counts() const { return counts_ + waiting_; }

 private:
  std::optional<FrameRefusal> refusalOf(const CapturedFrame& frame, TimePoint now) const;

  bool isDevice_ = true;
  std::optional<TimePoint> lastTime_;
  FrameCounts waiting_;  // since the last frame that went out
  FrameCounts counts_;
};

}  // namespace pleinair::hal
