#include "pipeline/runtime/output/output_stage.h"

#include <algorithm>
#include <cassert>
#include <numeric>
#include <utility>

namespace pleinair::runtime {
namespace {

/// A display that comes without an event is found after this.
constexpr hal::Duration kMaxReopenDelay = std::chrono::seconds(5);
/// More surfaces than any display lends.
constexpr std::size_t kMaxSurfaces = 16;

/// A surface is filled a refresh before its due time, or earlier where that takes long
/// (noteFilling()): a display wants it half a refresh before. It counts as shown in time only if it
/// is flipped at that one.
PresentationRules rulesOf(hal::Output* output, const hal::OutputFormat& format,
                          PresentationRules rules) {
  if (output == nullptr || output->surfaces() == nullptr) return rules;
  rules.lead = format.refresh ? format.refresh->period : hal::Duration{0};
  rules.tolerance = hal::Duration{0};
  return rules;
}

bool isSame(const hal::OutputRequest& one, const hal::OutputRequest& other) {
  return one.size == other.size && one.framePeriod == other.framePeriod;
}

}  // namespace

bool haveSameFrames(const hal::OutputFormat& one, const hal::OutputFormat& other) {
  return one.frame == other.frame && one.quarterTurns == other.quarterTurns;
}

OutputStage::OutputStage(std::unique_ptr<hal::Output> output, hal::OutputFormat format,
                         OutputStageOptions options, hal::Clock& clock, FrameLedger& ledger)
    : output_(std::move(output)),
      options_(std::move(options)),
      clock_(clock),
      ledger_(ledger),
      lending_(clock),
      format_(format),
      queue_(rulesOf(output_.get(), format_, options_.rules), options_.waiting),
      refresh_(format_.refresh),
      reopenAfter_(kFirstReopenDelay) {
  assert((output_ == nullptr) == options_.absence.has_value());
  queued_.reserve(kMaxSurfaces);
  events_.reserve(kMaxSurfaces);
  // One is written and one is filled while the others wait. The last one freed is reused first, so
  // that buffers which are never needed take no memory.
  const std::size_t buffers = options_.waiting + 2 + (options_.keepsLastFrame ? 1 : 0);
  for (std::size_t i = 0; i < buffers; ++i) {
    buffers_.push_back(std::make_unique<OutputFrame>());
    free_.push_back(buffers - 1 - i);
  }
  status_.name = options_.name;
  status_.format = format.frame;
  status_.starts = output_ == nullptr ? 0 : 1;
  if (output_ == nullptr) {
    status_.isFailed = true;
    status_.failure = options_.absence;
    reopenAt_ = clock_.now() + reopenAfter_;
  }
}

hal::OutputFormat OutputStage::format() const {
  const std::scoped_lock lock(mutex_);
  return format_;
}

OutputFrame& OutputStage::buffer() {
  const std::scoped_lock lock(mutex_);
  if (!filling_) {
    assert(!free_.empty());
    filling_ = free_.back();
    free_.pop_back();
  }
  return *buffers_.at(*filling_);
}

std::optional<hal::Duration> OutputStage::refreshPeriod() const {
  const std::scoped_lock lock(mutex_);
  return refresh_ ? std::optional(refresh_->period) : std::nullopt;
}

void OutputStage::submit(std::optional<FrameLedger::Ticket> ticket, hal::TimePoint ready,
                         hal::Duration latency) {
  const std::scoped_lock lock(mutex_);
  assert(filling_);
  const std::size_t buffer = *std::exchange(filling_, std::nullopt);
  ++status_.submitted;
  if (!ticket) ++status_.repeats;
  const hal::TimePoint captured = buffers_.at(buffer)->captureTime;
  const WaitingFrame frame{.buffer = buffer,
                           .sequence = buffers_.at(buffer)->sequence,
                           .ticket = ticket,
                           .captured = captured,
                           .ready = ready,
                           .due = dueTime(captured, latency, refresh_)};
  // A frame of the format before, that was in flight while the output was opened again.
  const OutputFrame& filled = *buffers_.at(buffer);
  const bool isOutdated = filled.surface ? !lending_.isCurrent(*filled.surface)
                                         : filled.image.format() != format_.frame;
  // While it fails, frames would fill the queue, and each of its buffers is kept for good.
  if (status_.isFailed || isOutdated) {
    end(frame, Outcome::kOutputFailed);
    return;
  }
  if (queue_.isFull()) {
    // If the oldest is not due yet, dropping the oldest each time would show none.
    if (*queue_.nextTime() > clock_.now()) {
      end(frame, Outcome::kOutputBusy);
      return;
    }
    end(queue_.removeOldest(), Outcome::kOutputBusy);
  }
  queue_.push(frame);
  isWoken_ = true;
  changed_.notify_all();
}

void OutputStage::end(const WaitingFrame& frame, Outcome outcome) {
  freeBuffer(frame.buffer);
  count(frame, outcome);
}

/// A surface with the frame goes back to the painter.
void OutputStage::freeBuffer(std::size_t buffer) {
  if (auto surface = std::exchange(buffers_.at(buffer)->surface, std::nullopt)) {
    lending_.giveBack(*surface);
  }
  free_.push_back(buffer);
}

/// As end(), for a frame whose buffer is free already. `known`: when it was shown, and which
/// refreshes it was and should have been.
void OutputStage::count(const WaitingFrame& frame, Outcome outcome, FrameRecord known) {
  ++status_.ended.at(static_cast<std::size_t>(outcome));
  if (frame.ticket) ledger_.end(*frame.ticket, outcome);
  if (options_.log == nullptr) return;
  known.output = options_.logNumber;
  known.sequence = frame.sequence;
  known.captured = frame.captured;
  known.ready = frame.ready;
  known.due = frame.due;
  known.outcome = outcome;
  options_.log->add(known);
}

/// As end(), for a frame that was handed over; its buffer may be kept. Precondition: the mutex is
/// held.
void OutputStage::retire(const WaitingFrame& frame) {
  if (!options_.keepsLastFrame || isFaded_ || isDirect_) {
    freeBuffer(frame.buffer);
    return;
  }
  if (last_) freeBuffer(*last_);
  last_ = frame.buffer;
  lastCopy_.reset();
}

void OutputStage::endAll(Outcome outcome) {
  for (const Queued& each : queued_) count(each.frame, outcome);
  queued_.clear();
  while (queue_.size() > 0) end(queue_.removeOldest(), outcome);
}

std::optional<OutputStage::Due> OutputStage::takeDue() {
  const std::scoped_lock lock(mutex_);
  while (auto decision = queue_.next(clock_.now())) {
    if (options_.limit && status_.presented + queued_.size() >= *options_.limit) {
      end(decision->frame, Outcome::kStopped);
      continue;
    }
    if (isShown(decision->outcome) && !status_.isFailed) {
      isWriting_ = true;
      return Due{decision->frame, decision->outcome};
    }
    end(decision->frame, status_.isFailed ? Outcome::kOutputFailed : decision->outcome);
  }
  return std::nullopt;
}

void OutputStage::handOver() {
  while (const std::optional<Due> due = takeDue()) present(*due);
}

std::optional<hal::TimePoint> OutputStage::step() {
  followRefusal();
  tryToReopen();
  applyRequest();
  takeEvents();
  copyLastFrame();
  followLending();
  handOver();
  presentWaiting();
  const std::scoped_lock lock(mutex_);
  ++status_.steps;
  std::optional<hal::TimePoint> next = queue_.nextTime();
  if (!queued_.empty() || waitingSurface_) {
    const auto event = output_->surfaces()->nextEvent();
    if (event) next = next ? std::min(*next, *event) : event;
  }
  if (status_.isFailed && !status_.isFinal) next = next ? std::min(*next, reopenAt_) : reopenAt_;
  return next;
}

void OutputStage::fail(hal::Error error) {
  status_.isFailed = true;
  status_.suspension.reset();
  status_.isFinal = !options_.reopen;
  ++status_.failures;
  status_.failure = std::move(error);
  reopenAt_ = clock_.now() + reopenAfter_;
  reopenAfter_ = std::min(2 * reopenAfter_, kMaxReopenDelay);
  endAll(Outcome::kOutputFailed);
  waiting_.reset();
  waitingSeen_.reset();
  waitingSurface_.reset();
  status_.isWaitingShown = false;
  fade_.end();
  isFading_ = false;
  directOnScreen_.reset();
  lending_.restart();
}

void OutputStage::refuse(const hal::OutputFormat& format, const hal::Error& error) {
  assert(reopens());
  const std::scoped_lock lock(mutex_);
  if (!haveSameFrames(format, format_)) return;
  isRefused_ = true;
  refusal_ = error;
  isWoken_ = true;
  changed_.notify_all();
}

bool OutputStage::isRefused() const {
  const std::scoped_lock lock(mutex_);
  return isRefused_;
}

void OutputStage::followRefusal() {
  const std::scoped_lock lock(mutex_);
  if (!refusal_) return;
  const hal::Error refusal = *std::exchange(refusal_, std::nullopt);
  // One that is not there has a reason of its own.
  if (!status_.isFailed) fail(refusal);
}

void OutputStage::tryToReopen() {
  {
    const std::scoped_lock lock(mutex_);
    if (!status_.isFailed || status_.isFinal || clock_.now() < reopenAt_) return;
    if (request_) options_.request = *std::exchange(request_, std::nullopt);
  }
  output_.reset();  // releases the device, which the new output opens
  auto opened = options_.reopen();
  auto format = opened ? (*opened)->start(options_.request)
                       : hal::Result<hal::OutputFormat>(tl::unexpected(opened.error()));
  const std::scoped_lock lock(mutex_);
  if (!format) {
    fail(std::move(format.error()));
    return;
  }
  output_ = std::move(*opened);
  endAll(Outcome::kOutputFailed);
  started(*format);
  firstTime_.reset();
  status_.isFailed = false;
}

/// Precondition: the mutex is held, and no frame waits.
void OutputStage::started(const hal::OutputFormat& format) {
  format_ = format;
  status_.format = format_.frame;
  queue_ = PresentationQueue(rulesOf(output_.get(), format_, options_.rules), options_.waiting);
  refresh_ = format_.refresh;
  fillTime_ = {};
  isRefused_ = false;
  refusal_.reset();  // of what it was before
  ++status_.starts;
}

void OutputStage::reconfigure(const hal::OutputRequest& request) {
  const std::scoped_lock lock(mutex_);
  request_ = request;
  isWoken_ = true;
  changed_.notify_all();
}

bool OutputStage::isReconfigured() const {
  const std::scoped_lock lock(mutex_);
  return !request_ || status_.isFailed;
}

void OutputStage::applyRequest() {
  hal::OutputRequest request;
  {
    const std::scoped_lock lock(mutex_);
    if (!request_ || status_.isFailed || !queued_.empty() || waitingSurface_) return;
    request = *request_;
    if (isSame(request, options_.request)) {
      request_.reset();
      return;
    }
  }
  hal::SurfaceOutput* surfaces = output_->surfaces();
  hal::Result<hal::OutputFormat> format = surfaces != nullptr
                                              ? surfaces->reconfigure(request)
                                              : output_->memory()->reconfigure(request);
  const std::scoped_lock lock(mutex_);
  request_.reset();
  options_.request = request;
  if (!format) {
    fail(std::move(format.error()));
    return;
  }
  endAll(Outcome::kStopped);
  waiting_.reset();
  lending_.restart();
  started(*format);
}

void OutputStage::wait(std::optional<hal::TimePoint> time) {
  constexpr hal::Duration kMaxWait = std::chrono::milliseconds(100);
  const hal::Duration patience =
      time ? std::clamp<hal::Duration>(*time - clock_.now(), hal::Duration{0}, kMaxWait) : kMaxWait;
  std::unique_lock lock(mutex_);
  changed_.wait_for(lock, patience, [this] { return isWoken_; });
  isWoken_ = false;
}

void OutputStage::wake() {
  const std::scoped_lock lock(mutex_);
  isWoken_ = true;
  changed_.notify_all();
}

hal::Result<void> OutputStage::finish() {
  takeEvents();
  handOver();
  keepLastFrame();
  {
    const std::scoped_lock lock(mutex_);
    endAll(Outcome::kStopped);
    if (status_.isFailed) return tl::unexpected(*status_.failure);
    // An empty movie must not replace an existing one.
    if (status_.presented == 0) return {};
  }
  return output_->finish();
}

void OutputStage::retry() {
  const std::scoped_lock lock(mutex_);
  reopenAt_ = clock_.now();
  reopenAfter_ = kFirstReopenDelay;
  isWoken_ = true;
  changed_.notify_all();
}

void OutputStage::noteActivity() {
  const std::scoped_lock lock(mutex_);
  isSomebodyThere_ = true;
  // An output that shows pictures has time until the next one.
  if (!status_.suspension) return;
  isWoken_ = true;
  changed_.notify_all();
}

bool OutputStage::isFull() const {
  const std::scoped_lock lock(mutex_);
  return options_.limit && status_.presented >= *options_.limit;
}

bool OutputStage::isBlanked() const {
  const std::scoped_lock lock(mutex_);
  return status_.suspension && status_.suspension->cause == hal::Suspension::Cause::kBlank;
}

bool OutputStage::isIdle() const {
  const std::scoped_lock lock(mutex_);
  return queue_.size() == 0 && queued_.empty() && !waitingSurface_ && !isWriting_;
}

bool OutputStage::Status::addsUp() const {
  return submitted == waiting + std::accumulate(ended.begin(), ended.end(), std::uint64_t{0});
}

OutputStage::Status OutputStage::status() const {
  const std::scoped_lock lock(mutex_);
  Status status = status_;
  status.waiting = queue_.size() + queued_.size() + (isWriting_ ? 1 : 0);
  status.refresh = refresh_;
  status.isWaitingDue = waiting_ != nullptr;
  const hal::TimePoint now = clock_.now();
  status.perSecond = rate_.perSecond(now);
  status.latency = latency_.recent(now);
  status.latencySum = latency_.sum();
  status.writing = writing_.recent(now);
  status.scanOut = lending_.status();
  return status;
}

}  // namespace pleinair::runtime
