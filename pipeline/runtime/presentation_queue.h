#pragma once

#include <chrono>
#include <cstddef>
#include <optional>
#include <vector>

#include "hal/clock.h"
#include "hal/output.h"
#include "pipeline/runtime/frame_ledger.h"
#include "pipeline/runtime/outcome.h"

namespace pleinair::runtime {

/// When a frame captured at `captured` is to be seen: captured + latency, or, on a display whose
/// refreshes are known to the moment, the first of them at or after that.
hal::TimePoint dueTime(hal::TimePoint captured, hal::Duration latency,
                       const std::optional<hal::Refresh>& refresh);

/// A painted picture that waits to be shown.
struct WaitingPicture {
  std::size_t buffer = 0;                     ///< where its pixels are
  std::optional<FrameLedger::Ticket> ticket;  ///< of its frame; none for repeats
  hal::TimePoint captured;
  hal::TimePoint ready;  ///< when it was painted
  hal::TimePoint due;
  hal::Duration readyGap{0};  ///< since the one before it was ready; push() sets it
};

struct PresentationRules {
  /// Without it pictures are handed on as they come, each one: files.
  bool isPaced = true;
  /// How long after its due time a picture still counts as being in time. A refresh allows none for
  /// painting; the clock's own waking may be so late.
  hal::Duration tolerance = std::chrono::milliseconds(8);
  /// How long before its due time a picture is handed over: displays take it for their next
  /// refresh.
  hal::Duration lead{0};
  /// Late pictures are shown where else nothing new would be seen for longer than this; and those
  /// that are still to come, where the latency has just risen.
  hal::Duration longestGap = std::chrono::milliseconds(200);
};

/// Decides which picture is shown when, and how each of the others ends
/// (docs/decisions/0009-fixed-latency.md). Time goes in as an argument. One thread; allocates
/// nothing beyond its capacity.
class PresentationQueue {
 public:
  PresentationQueue(PresentationRules rules, std::size_t capacity);

  std::size_t size() const { return waiting_.size(); }
  bool isFull() const { return waiting_.size() == capacity_; }

  /// Precondition: !isFull(), captured later than the ones before. A due time before that of an
  /// earlier picture (the latency fell) is moved to it.
  void push(WaitingPicture picture);
  /// The oldest, to make room for a newer one. Precondition: size() > 0.
  WaitingPicture removeOldest();

  struct Ruling {
    WaitingPicture picture;
    Outcome outcome{};  ///< isShown(): to be presented now; otherwise dropped for this reason
  };
  /// Rules on the oldest picture, if it is due; to be called until it gives nothing.
  std::optional<Ruling> next(hal::TimePoint now);
  /// When next() has something to rule on.
  std::optional<hal::TimePoint> nextTime() const;

  /// The last picture has been taken at `now`: what fell due meanwhile did so while it was busy.
  void presented(hal::TimePoint now) { busyUntil_ = now; }

 private:
  hal::TimePoint handOverTime(const WaitingPicture& picture) const {
    return picture.due - rules_.lead;
  }
  hal::TimePoint timeOf(const WaitingPicture& picture) const;
  bool isReadyInTime(const WaitingPicture& picture) const;
  bool wouldFreeze(hal::TimePoint now) const;
  Outcome outcomeOfDropped(const WaitingPicture& picture, bool hasNewer) const;
  Outcome outcomeOfNewest(const WaitingPicture& picture, hal::TimePoint now) const;

  PresentationRules rules_;
  std::size_t capacity_;
  std::vector<WaitingPicture> waiting_;  ///< oldest first
  std::optional<hal::TimePoint> shown_;  ///< when the last one was
  hal::TimePoint busyUntil_;
  std::optional<hal::TimePoint> lastReady_;
  hal::Duration readyGap_{0};  ///< between the last two
};

}  // namespace pleinair::runtime
