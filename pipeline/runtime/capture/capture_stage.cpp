#include "pipeline/runtime/capture/capture_stage.h"

#include <utility>
#include <variant>

namespace pleinair::runtime {

CaptureStage::CaptureStage(hal::CameraSupervisor& camera, hal::Clock& clock, FrameLedger& ledger,
                           Mailbox<ArrivedFrame>& frames)
    : camera_(camera), clock_(clock), ledger_(ledger), frames_(frames) {}

void CaptureStage::open() {
  const std::scoped_lock lock(mutex_);
  isOpen_ = true;
}

void CaptureStage::step(hal::TimePoint deadline) {
  if (hasEnded_) {
    clock_.sleepUntil(deadline);
    return;
  }
  hal::SupervisedNext next = camera_.next(deadline);
  countLost();
  if (auto* frame = std::get_if<hal::SupervisedFrame>(&next)) {
    handOn(std::move(frame->frame));
    return;
  }
  const std::scoped_lock lock(mutex_);
  if (auto* changed = std::get_if<hal::FormatChanged>(&next)) {
    status_.format = changed->format;
    movedAt_ = clock_.now();
  } else if (auto* state = std::get_if<hal::CameraStateChanged>(&next)) {
    status_.state = state->state;
    status_.reason = std::move(state->reason);
    if (state->camera) status_.camera = std::move(state->camera);
    if (state->state == hal::CameraState::kLost) {
      status_.lastLoss = status_.reason;
      status_.cause = std::move(state->cause);
    }
  } else if (auto* end = std::get_if<hal::EndOfStream>(&next)) {
    status_.hasEnded = true;
    status_.cause = std::move(end->truncated);
    hasEnded_ = true;
  }
  frames_.wake();
}

/// Enters frames that the supervisor dropped, even if no valid frame follows.
void CaptureStage::countLost() {
  const hal::FrameCounts counts = camera_.frameCounts();
  const std::uint64_t underruns = counts.underruns - counted_.underruns;
  ledger_.count(Outcome::kStalled, counts.lostInStall - counted_.lostInStall);
  ledger_.count(Outcome::kBufferUnderrun, underruns);
  ledger_.count(Outcome::kDroppedByDriver, counts.dropped - counted_.dropped - underruns);
  ledger_.count(Outcome::kCorrupt, counts.corrupt - counted_.corrupt);
  ledger_.count(Outcome::kIncomplete, counts.incomplete - counted_.incomplete);
  ledger_.count(Outcome::kMisTimed, counts.misTimed - counted_.misTimed);
  counted_ = counts;
}

void CaptureStage::handOn(hal::CapturedFrame frame) {
  const hal::TimePoint now = clock_.now();
  const bool moved = movement_.look(frame.image, frame.captureTime);
  {
    const std::scoped_lock lock(mutex_);
    if (moved) movedAt_ = now;
    rate_.count(now);
    delay_.add(now - frame.captureTime, now);
    if (!isOpen_) {
      ledger_.count(Outcome::kStarting);
      return;
    }
    ++status_.arrived;
  }
  const FrameLedger::Ticket ticket = ledger_.open();
  const auto replaced = frames_.put({std::move(frame), ticket, now});
  if (replaced) ledger_.end(replaced->ticket, Outcome::kReplaced);
}

CaptureStage::Status CaptureStage::status() const {
  const hal::SupervisorCounts counts = camera_.status().counts;
  const std::scoped_lock lock(mutex_);
  Status status = status_;
  const hal::TimePoint now = clock_.now();
  status.perSecond = rate_.perSecond(now);
  status.stalls = counts.stalls;
  status.losses = counts.losses;
  status.opens = counts.opens;
  status.link = counts.frames.link;
  status.delay = delay_.recent(now).percentile(0.5);
  if (movedAt_) status.quiet = now - *movedAt_;
  return status;
}

std::optional<hal::TimePoint> CaptureStage::movedAt() const {
  const std::scoped_lock lock(mutex_);
  return movedAt_;
}

}  // namespace pleinair::runtime
