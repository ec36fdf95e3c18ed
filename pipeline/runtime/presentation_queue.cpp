#include "pipeline/runtime/presentation_queue.h"

#include <algorithm>
#include <cassert>

namespace pleinair::runtime {

hal::TimePoint dueTime(hal::TimePoint captured, hal::Duration latency,
                       const std::optional<hal::Refresh>& refresh) {
  const hal::TimePoint earliest = captured + latency;
  if (!refresh || !refresh->phase) return earliest;
  assert(refresh->period > hal::Duration::zero());
  hal::Duration past = (earliest - *refresh->phase) % refresh->period;
  if (past < hal::Duration::zero()) past += refresh->period;
  return past == hal::Duration::zero() ? earliest : earliest + (refresh->period - past);
}

PresentationQueue::PresentationQueue(PresentationRules rules, std::size_t capacity)
    : rules_(rules), capacity_(capacity) {
  waiting_.reserve(capacity);
}

void PresentationQueue::push(WaitingPicture picture) {
  assert(!isFull());
  if (!waiting_.empty()) {
    assert(picture.captured > waiting_.back().captured);
    picture.due = std::max(picture.due, waiting_.back().due);
  }
  if (lastReady_) readyGap_ = picture.ready - *lastReady_;
  lastReady_ = picture.ready;
  picture.readyGap = readyGap_;
  waiting_.push_back(picture);
}

WaitingPicture PresentationQueue::removeOldest() {
  assert(!waiting_.empty());
  const WaitingPicture oldest = waiting_.front();
  waiting_.erase(waiting_.begin());
  return oldest;
}

std::optional<hal::TimePoint> PresentationQueue::nextTime() const {
  if (waiting_.empty()) return std::nullopt;
  return timeOf(waiting_.front());
}

/// When a picture is shown, as far as is known now.
hal::TimePoint PresentationQueue::timeOf(const WaitingPicture& picture) const {
  if (!rules_.isPaced) return picture.ready;
  // Pictures keep coming, so that a pause would be one of ours.
  if (shown_ && picture.readyGap <= rules_.longestGap) {
    return std::min(handOverTime(picture), std::max(picture.ready, *shown_ + rules_.longestGap));
  }
  return handOverTime(picture);
}

std::optional<PresentationQueue::Ruling> PresentationQueue::next(hal::TimePoint now) {
  const std::optional<hal::TimePoint> time = nextTime();
  if (!time || *time > now) return std::nullopt;
  const bool hasNewer = waiting_.size() > 1 && handOverTime(waiting_[1]) <= now;
  const WaitingPicture picture = removeOldest();
  Outcome outcome = Outcome::kShown;
  if (rules_.isPaced) {
    outcome = hasNewer ? outcomeOfDropped(picture, hasNewer) : outcomeOfNewest(picture, now);
  }
  if (isShown(outcome)) shown_ = now;
  return Ruling{picture, outcome};
}

bool PresentationQueue::isReadyInTime(const WaitingPicture& picture) const {
  return picture.ready <= picture.due + rules_.tolerance;
}

bool PresentationQueue::wouldFreeze(hal::TimePoint now) const {
  if (!shown_) return true;
  const hal::Duration untilNext = std::min(readyGap_, rules_.longestGap);
  return now - *shown_ + untilNext > rules_.longestGap;
}

Outcome PresentationQueue::outcomeOfDropped(const WaitingPicture& picture, bool hasNewer) const {
  if (!isReadyInTime(picture)) return Outcome::kLate;
  const bool wasBusy = picture.due < busyUntil_;
  return hasNewer && !wasBusy ? Outcome::kSuperseded : Outcome::kOutputBusy;
}

Outcome PresentationQueue::outcomeOfNewest(const WaitingPicture& picture,
                                           hal::TimePoint now) const {
  if (now < handOverTime(picture)) return Outcome::kShownOffSchedule;
  if (std::max(picture.ready, now) <= picture.due + rules_.tolerance) return Outcome::kShown;
  if (wouldFreeze(now)) return Outcome::kShownOffSchedule;
  return outcomeOfDropped(picture, false);
}

}  // namespace pleinair::runtime
