#include "hal/outputs/display/flip_queue.h"

#include <algorithm>
#include <cassert>
#include <cerrno>
#include <iterator>
#include <utility>

namespace pleinair::hal::display {
namespace {

using State = DisplayBuffer::State;

constexpr Duration kFlipPatience = std::chrono::seconds(1);
constexpr std::size_t kMaxQueued = 16;  // beyond, it allocates
constexpr Duration kRetryInterval = std::chrono::milliseconds(1);

}  // namespace

void FlipQueue::begin(DisplayBuffer& shown) {
  queue_.reserve(kMaxQueued);
  onScreen_ = &shown;
  onScreen_->state = State::kOnScreen;
  readTiming();
}

void FlipQueue::readTiming() {
  period_ = pipe_.mode().period;
  const std::optional<Vblank> last = pipe_.card().lastVblank(pipe_.crtc());
  hasVblank_ = last.has_value();
  // Without vertical blanking, any instant will do for a refresh.
  phase_ = last ? last->time : clock_.now();
  lastSequence_ = last ? last->sequence : 0;
  // Flips that an earlier output of this CRTC did not live to see.
  flips_.clear();
  pipe_.shared().takeFlips(pipe_.crtc(), flips_);
  flips_.clear();
}

/// A driver that nobody asks stops counting, and may begin with another phase.
void FlipQueue::followRefresh() {
  if (!hasVblank_ || flipping_ != nullptr) return;
  const std::optional<Vblank> last = pipe_.card().lastVblank(pipe_.crtc());
  if (!last || last->sequence < lastSequence_) return;
  phase_ = last->time;
  lastSequence_ = last->sequence;
}

Refresh FlipQueue::refresh() const {
  Refresh refresh{.period = period_, .phase = phase_};
  if (hasVblank_) refresh.sequence = lastSequence_;
  return refresh;
}

void FlipQueue::push(DisplayBuffer& buffer, Fence fence, TimePoint due) {
  assert(buffer.state == State::kLent && !buffer.isMapped);
  buffer.state = State::kQueued;
  queue_.push_back({.buffer = &buffer, .fence = std::move(fence), .due = due});
}

int FlipQueue::takeFlips() {
  flips_.clear();
  const int failed = pipe_.shared().takeFlips(pipe_.crtc(), flips_);
  for (const FlipEvent& each : flips_) flipped(each);
  return failed;
}

void FlipQueue::flipped(const FlipEvent& flip) {
  if (flipping_ == nullptr) return;
  if (onScreen_ != nullptr) onScreen_->state = State::kFree;
  onScreen_ = std::exchange(flipping_, nullptr);
  onScreen_->state = State::kOnScreen;
  PresentationEvent event{.surface = onScreen_->surface.id,
                          .result = PresentationEvent::Result::kShown,
                          .sequence = std::nullopt,
                          .time = flip.time};
  if (hasVblank_) {
    event.sequence = extended(flip.sequence);
    phase_ = flip.time;
  }
  events_.push_back(event);
}

/// The count in 64 bits, which the kernel tells the lower 32 of.
std::uint64_t FlipQueue::extended(std::uint32_t sequence) {
  const auto step =
      static_cast<std::uint32_t>(sequence - static_cast<std::uint32_t>(lastSequence_));
  lastSequence_ += step;
  return lastSequence_;
}

/// When to hand a surface to the card, so that it is shown at the refresh nearest to its due time.
TimePoint FlipQueue::commitTime(const Queued& queued) const {
  const TimePoint earliest = queued.due - period_ / 2;
  // With vertical blanking the card waits for the refresh, else it shows the surface at once.
  return hasVblank_ ? earliest : refreshAtOrAfter(earliest, phase_, period_);
}

bool FlipQueue::isReady(const Queued& queued, TimePoint now) const {
  return commitTime(queued) <= now && queued.fence.hasSignalled();
}

int FlipQueue::commitNext(TimePoint now) {
  if (flipping_ != nullptr || now < retryAt_) return 0;
  std::size_t ready = 0;
  while (ready < queue_.size() && isReady(queue_[ready], now)) ++ready;
  const bool isWaitedFor =
      ready == 0 && pipe_.waitsForFences() && !queue_.empty() && commitTime(queue_.front()) <= now;
  if (ready == 0 && !isWaitedFor) return 0;
  for (; ready > 1; --ready) {
    end(*queue_.front().buffer, PresentationEvent::Result::kSuperseded, now);
    queue_.erase(queue_.begin());
  }
  DisplayBuffer& next = *queue_.front().buffer;
  const int failed = pipe_.flipTo(next, isWaitedFor ? queue_.front().fence.syncFile() : -1);
  if (failed == -EBUSY) {
    // The flip before is not quite over.
    if (!busySince_) busySince_ = now;
    retryAt_ = now + kRetryInterval;
    return 0;
  }
  busySince_.reset();
  queue_.erase(queue_.begin());
  if (failed != 0) {
    end(next, PresentationEvent::Result::kSkipped, now);
    const bool isGpuRefused = next.gpu.has_value() && (failed == -EINVAL || failed == -ERANGE);
    isGpuRefused_ = isGpuRefused_ || isGpuRefused;
    return failed == -ENOMEM || isGpuRefused ? 0 : failed;
  }
  next.state = State::kFlipping;
  flipping_ = &next;
  committed_ = now;
  return 0;
}

void FlipQueue::end(DisplayBuffer& buffer, PresentationEvent::Result result, TimePoint time) {
  buffer.state = State::kFree;
  events_.push_back(
      {.surface = buffer.surface.id, .result = result, .sequence = std::nullopt, .time = time});
}

void FlipQueue::skipQueued(TimePoint now) {
  for (const Queued& each : queue_) end(*each.buffer, PresentationEvent::Result::kSkipped, now);
  queue_.clear();
  busySince_.reset();
}

void FlipQueue::skipFlipping(TimePoint now) {
  if (flipping_ == nullptr) return;
  end(*std::exchange(flipping_, nullptr), PresentationEvent::Result::kSkipped, now);
}

bool FlipQueue::isOverdue(TimePoint now) const {
  const bool isMissing = flipping_ != nullptr && now - committed_ > kFlipPatience;
  // Asked again meanwhile: this program may itself have stood still.
  const bool isBusy = busySince_ && retryAt_ - *busySince_ > kFlipPatience;
  return isMissing || isBusy;
}

void FlipQueue::blackenScreen() {
  if (onScreen_ == nullptr) return;
  if (onScreen_->gpu) {
    const auto free = std::ranges::find(pipe_.buffers(), State::kFree, &DisplayBuffer::state);
    if (free == pipe_.buffers().end()) return;
    onScreen_->state = State::kFree;
    onScreen_ = &*free;
    onScreen_->state = State::kOnScreen;
  }
  std::ranges::fill(onScreen_->memory.memory, std::uint8_t{0});
}

void FlipQueue::takeEvents(std::vector<PresentationEvent>& events) {
  std::ranges::copy(events_, std::back_inserter(events));
  events_.clear();
}

std::optional<TimePoint> FlipQueue::nextEvent() const {
  const TimePoint now = clock_.now();
  if (!events_.empty()) return now;
  if (flipping_ != nullptr) {
    // The event follows the refresh; it is asked for again and again once that has passed.
    const TimePoint refresh = refreshAtOrAfter(committed_, phase_, period_);
    return std::max(refresh, now + kRetryInterval);
  }
  if (queue_.empty()) return std::nullopt;
  const bool isOnlyUnfinished =
      commitTime(queue_.front()) <= now && !queue_.front().fence.hasSignalled();
  if (isOnlyUnfinished) return now + kRetryInterval;
  return std::max(commitTime(queue_.front()), std::max(retryAt_, now));
}

}  // namespace pleinair::hal::display
