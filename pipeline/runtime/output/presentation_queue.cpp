#include "pipeline/runtime/output/presentation_queue.h"

#include <algorithm>
#include <cassert>

namespace pleinair::runtime {

hal::TimePoint dueTime(hal::TimePoint captured, hal::Duration latency,
                       const std::optional<hal::Refresh>& refresh) {
  const hal::TimePoint earliest = captured + latency;
  if (!refresh || !refresh->phase) return earliest;
  assert(refresh->period > hal::Duration::zero());
  return hal::refreshAtOrAfter(earliest, *refresh->phase, refresh->period);
}

PresentationQueue::PresentationQueue(PresentationRules rules, std::size_t capacity)
    : rules_(rules), capacity_(capacity) {
  waiting_.reserve(capacity);
}

void PresentationQueue::push(WaitingFrame frame) {
  assert(!isFull());
  if (!waiting_.empty()) {
    assert(frame.captured > waiting_.back().captured);
    frame.due = std::max(frame.due, waiting_.back().due);
  }
  if (lastReady_) readyGap_ = frame.ready - *lastReady_;
  lastReady_ = frame.ready;
  frame.readyGap = readyGap_;
  waiting_.push_back(frame);
}

WaitingFrame PresentationQueue::removeOldest() {
  assert(!waiting_.empty());
  const WaitingFrame oldest = waiting_.front();
  waiting_.erase(waiting_.begin());
  return oldest;
}

std::optional<hal::TimePoint> PresentationQueue::nextTime() const {
  if (waiting_.empty()) return std::nullopt;
  return timeOf(waiting_.front());
}

/// When to decide on a frame, as far as is known now.
hal::TimePoint PresentationQueue::timeOf(const WaitingFrame& frame) const {
  if (!rules_.isPaced) return frame.ready;
  // Frames keep coming, so a freeze would be the runtime's fault.
  if (shown_ && frame.readyGap <= rules_.maxGap) {
    return std::min(handOverTime(frame), std::max(frame.ready, *shown_ + rules_.maxGap));
  }
  return handOverTime(frame);
}

std::optional<PresentationQueue::Decision> PresentationQueue::next(hal::TimePoint now) {
  const std::optional<hal::TimePoint> time = nextTime();
  if (!time || *time > now) return std::nullopt;
  const bool hasNewer = waiting_.size() > 1 && handOverTime(waiting_[1]) <= now;
  const WaitingFrame frame = removeOldest();
  Outcome outcome = Outcome::kShown;
  if (rules_.isPaced) {
    outcome = hasNewer ? outcomeOfDropped(frame, hasNewer) : outcomeOfNewest(frame, now);
  }
  if (isShown(outcome)) shown_ = now;
  return Decision{frame, outcome};
}

bool PresentationQueue::isReadyInTime(const WaitingFrame& frame) const {
  return frame.ready <= frame.due + rules_.tolerance;
}

bool PresentationQueue::wouldFreeze(hal::TimePoint now) const {
  if (!shown_) return true;
  const hal::Duration untilNext = std::min(readyGap_, rules_.maxGap);
  return now - *shown_ + untilNext > rules_.maxGap;
}

Outcome PresentationQueue::outcomeOfDropped(const WaitingFrame& frame, bool hasNewer) const {
  if (!isReadyInTime(frame)) return Outcome::kLate;
  const bool wasBusy = frame.due < busyUntil_;
  return hasNewer && !wasBusy ? Outcome::kSuperseded : Outcome::kOutputBusy;
}

Outcome PresentationQueue::outcomeOfNewest(const WaitingFrame& frame, hal::TimePoint now) const {
  if (now < handOverTime(frame)) return Outcome::kShownOffSchedule;
  if (std::max(frame.ready, now) <= frame.due + rules_.tolerance) return Outcome::kShown;
  if (wouldFreeze(now)) return Outcome::kShownOffSchedule;
  return outcomeOfDropped(frame, false);
}

}  // namespace pleinair::runtime
