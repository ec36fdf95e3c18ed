#include "pipeline/runtime/output_stage.h"

#include <algorithm>
#include <cassert>
#include <numeric>
#include <utility>

namespace pleinair::runtime {
namespace {

constexpr hal::Duration kFirstReopening = std::chrono::milliseconds(500);
constexpr hal::Duration kLongestReopening = std::chrono::seconds(8);

}  // namespace

OutputStage::OutputStage(std::unique_ptr<hal::Output> output, hal::OutputFormat format,
                         OutputStageOptions options, hal::Clock& clock, FrameLedger& ledger)
    : output_(std::move(output)),
      format_(format),
      options_(std::move(options)),
      clock_(clock),
      ledger_(ledger),
      reopenAfter_(kFirstReopening),
      queue_(options_.rules, options_.waiting) {
  // One is being taken and one is being filled while the others wait. The last freed is filled
  // first, so that those which are never needed take no memory.
  for (std::size_t i = 0; i < options_.waiting + 2; ++i) {
    buffers_.push_back(std::make_unique<OutputFrame>());
    free_.push_back(options_.waiting + 1 - i);
  }
  status_.name = options_.name;
  status_.format = format.frame;
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

void OutputStage::submit(std::optional<FrameLedger::Ticket> ticket, hal::TimePoint ready,
                         hal::TimePoint due) {
  const std::scoped_lock lock(mutex_);
  assert(filling_);
  const std::size_t buffer = *std::exchange(filling_, std::nullopt);
  ++status_.submitted;
  if (!ticket) ++status_.repeats;
  const WaitingPicture picture{.buffer = buffer,
                               .ticket = ticket,
                               .captured = buffers_.at(buffer)->captureTime,
                               .ready = ready,
                               .due = due};
  if (status_.isFinal) {
    end(picture, Outcome::kOutputFailed);
    return;
  }
  if (queue_.isFull()) {
    // Where the oldest is still waiting for its time, dropping it again and again would show none.
    if (*queue_.nextTime() > clock_.now()) {
      end(picture, Outcome::kOutputBusy);
      return;
    }
    end(queue_.removeOldest(), Outcome::kOutputBusy);
  }
  queue_.push(picture);
  isWoken_ = true;
  changed_.notify_all();
}

void OutputStage::end(const WaitingPicture& picture, Outcome outcome) {
  free_.push_back(picture.buffer);
  ++status_.ended.at(static_cast<std::size_t>(outcome));
  if (picture.ticket) ledger_.end(*picture.ticket, outcome);
}

void OutputStage::endAll(Outcome outcome) {
  while (queue_.size() > 0) end(queue_.removeOldest(), outcome);
}

std::optional<OutputStage::Due> OutputStage::takeDue() {
  const std::scoped_lock lock(mutex_);
  while (auto ruling = queue_.next(clock_.now())) {
    if (options_.limit && status_.presented >= *options_.limit) {
      end(ruling->picture, Outcome::kStopped);
      continue;
    }
    if (isShown(ruling->outcome) && !status_.isFailed) {
      isWriting_ = true;
      return Due{ruling->picture, ruling->outcome};
    }
    end(ruling->picture, status_.isFailed ? Outcome::kOutputFailed : ruling->outcome);
  }
  return std::nullopt;
}

void OutputStage::handOver() {
  while (const std::optional<Due> due = takeDue()) present(*due);
}

std::optional<hal::TimePoint> OutputStage::step() {
  tryToReopen();
  handOver();
  const std::scoped_lock lock(mutex_);
  std::optional<hal::TimePoint> next = queue_.nextTime();
  if (status_.isFailed && !status_.isFinal) next = next ? std::min(*next, reopenAt_) : reopenAt_;
  return next;
}

/// Since the first picture that this opening of the output has got.
hal::Duration OutputStage::timeOf(const WaitingPicture& picture) {
  if (!firstTime_) firstTime_ = picture.captured;
  return picture.captured - *firstTime_;
}

void OutputStage::present(const Due& due) {
  const hal::TimePoint began = clock_.now();
  const hal::ImageView view = buffers_.at(due.picture.buffer)->image.view();
  hal::MemoryOutput& output = *output_->memory();
  const std::uint64_t skippedBefore = output.skippedPictures();
  hal::Result<void> written = output.write(view, timeOf(due.picture));
  const bool isSkipped = output.skippedPictures() > skippedBefore;
  const hal::TimePoint ended = clock_.now();
  const std::scoped_lock lock(mutex_);
  isWriting_ = false;
  queue_.presented(ended);
  writing_.add(ended - began, ended);
  if (!written) {
    end(due.picture, Outcome::kOutputFailed);
    fail(std::move(written.error()));
    return;
  }
  reopenAfter_ = kFirstReopening;
  if (isSkipped) {
    end(due.picture, Outcome::kOutputBusy);
    return;
  }
  ++status_.presented;
  rate_.count(began);
  latency_.add(began - due.picture.captured, began);
  end(due.picture, due.outcome);
}

void OutputStage::fail(hal::Error error) {
  status_.isFailed = true;
  status_.isFinal = !options_.reopen;
  ++status_.failures;
  status_.failure = std::move(error);
  reopenAt_ = clock_.now() + reopenAfter_;
  reopenAfter_ = std::min(2 * reopenAfter_, kLongestReopening);
  endAll(Outcome::kOutputFailed);
}

void OutputStage::tryToReopen() {
  {
    const std::scoped_lock lock(mutex_);
    if (!status_.isFailed || status_.isFinal || clock_.now() < reopenAt_) return;
  }
  output_.reset();  // before another takes the device
  auto opened = options_.reopen();
  auto format = opened ? (*opened)->start(options_.request)
                       : hal::Result<hal::OutputFormat>(tl::unexpected(opened.error()));
  const std::scoped_lock lock(mutex_);
  if (format && format->frame != format_.frame) {
    format = tl::unexpected(hal::Error{.kind = hal::ErrorKind::kUnsupported,
                                       .subject = options_.name,
                                       .problem = "takes another format than before"});
  }
  if (!format) {
    fail(std::move(format.error()));
    return;
  }
  output_ = std::move(*opened);
  firstTime_.reset();
  status_.isFailed = false;
}

void OutputStage::wait(std::optional<hal::TimePoint> time) {
  constexpr hal::Duration kLongest = std::chrono::milliseconds(100);
  const hal::Duration patience =
      time ? std::clamp<hal::Duration>(*time - clock_.now(), hal::Duration{0}, kLongest) : kLongest;
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
  handOver();
  {
    const std::scoped_lock lock(mutex_);
    endAll(Outcome::kStopped);
    if (status_.isFailed) return tl::unexpected(*status_.failure);
    // A movie of nothing is not to take the place of one that is there.
    if (status_.presented == 0) return {};
  }
  return output_->finish();
}

bool OutputStage::isFull() const {
  const std::scoped_lock lock(mutex_);
  return options_.limit && status_.presented >= *options_.limit;
}

bool OutputStage::isIdle() const {
  const std::scoped_lock lock(mutex_);
  return queue_.size() == 0 && !isWriting_;
}

bool OutputStage::Status::addsUp() const {
  return submitted == waiting + std::accumulate(ended.begin(), ended.end(), std::uint64_t{0});
}

OutputStage::Status OutputStage::status() const {
  const std::scoped_lock lock(mutex_);
  Status status = status_;
  status.waiting = queue_.size() + (isWriting_ ? 1 : 0);
  const hal::TimePoint now = clock_.now();
  status.perSecond = rate_.perSecond(now);
  status.latency = latency_.recent(now);
  status.latencySum = latency_.sum();
  status.writing = writing_.recent(now);
  return status;
}

}  // namespace pleinair::runtime
