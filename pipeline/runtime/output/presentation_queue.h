#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "hal/clock.h"
#include "hal/output.h"
#include "pipeline/runtime/frame_ledger.h"
#include "pipeline/runtime/outcome.h"

namespace pleinair::runtime {

/// When a frame captured at `captured` is to be shown: captured + latency, or, if the phase of the
/// refresh is known, the first refresh at or after that.
hal::TimePoint dueTime(hal::TimePoint captured, hal::Duration latency,
                       const std::optional<hal::Refresh>& refresh);

/// An output frame that waits to be shown.
struct WaitingFrame {
  std::size_t buffer = 0;                     ///< index of the buffer with its pixels
  std::uint64_t sequence = 0;                 ///< the camera's
  std::optional<FrameLedger::Ticket> ticket;  ///< of the captured frame; unset for repeats
  hal::TimePoint captured;
  hal::TimePoint ready;  ///< when the output frame was complete
  hal::TimePoint due;
  hal::Duration readyGap{0};  ///< time since the previous one was ready; push() sets it
};

struct PresentationRules {
  /// If unset, each frame is handed over at once: files.
  bool isPaced = true;
  /// A frame that is ready, or handed over, by so much after its due time is still in time: the
  /// thread may wake late.
  hal::Duration tolerance = std::chrono::milliseconds(8);
  /// Time from handing a frame over to its due time: a display shows it at its next refresh.
  hal::Duration lead{0};
  /// The display must not freeze for longer: late frames are shown nevertheless, and frames are
  /// shown before their due times when the latency has just risen.
  hal::Duration maxGap = std::chrono::milliseconds(200);
};

/// Decides which frame is shown when, and the outcome of each of the others
/// (docs/decisions/0009-fixed-latency.md). The caller passes the time. One thread; allocates only
/// in its constructor.
class PresentationQueue {
 public:
  PresentationQueue(PresentationRules rules, std::size_t capacity);

  std::size_t size() const { return waiting_.size(); }
  bool isFull() const { return waiting_.size() == capacity_; }

  /// Adds a frame. A due time before that of an earlier frame (the latency fell) is raised to it.
  /// Precondition: !isFull(), and it was captured later than those before.
  void push(WaitingFrame frame);
  /// Takes the oldest frame out, to make room for a newer one. Precondition: size() > 0.
  WaitingFrame removeOldest();

  struct Decision {
    WaitingFrame frame;
    Outcome outcome{};  ///< present it now if isShown(outcome); otherwise the drop reason
  };
  /// Takes the oldest frame out if it is due, and decides on it. Call until it gives nothing.
  std::optional<Decision> next(hal::TimePoint now);
  /// When next() will give something; unset while the queue is empty.
  std::optional<hal::TimePoint> nextTime() const;

  /// From now on.
  void setLead(hal::Duration lead) { rules_.lead = lead; }
  /// The output has taken the last frame at `now`: it was busy when frames fell due before that.
  void presented(hal::TimePoint now) { busyUntil_ = now; }

 private:
  hal::TimePoint handOverTime(const WaitingFrame& frame) const { return frame.due - rules_.lead; }
  hal::TimePoint timeOf(const WaitingFrame& frame) const;
  bool isReadyInTime(const WaitingFrame& frame) const;
  bool wouldFreeze(hal::TimePoint now) const;
  Outcome outcomeOfDropped(const WaitingFrame& frame, bool hasNewer) const;
  Outcome outcomeOfNewest(const WaitingFrame& frame, hal::TimePoint now) const;

  PresentationRules rules_;
  std::size_t capacity_;
  std::vector<WaitingFrame> waiting_;    ///< oldest first
  std::optional<hal::TimePoint> shown_;  ///< when the last one was handed over
  hal::TimePoint busyUntil_;
  std::optional<hal::TimePoint> lastReady_;
  hal::Duration readyGap_{0};  ///< time between the last two that were ready
};

}  // namespace pleinair::runtime
