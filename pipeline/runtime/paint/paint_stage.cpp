#include "pipeline/runtime/paint/paint_stage.h"

#include <algorithm>
#include <cassert>
#include <thread>
#include <utility>

namespace pleinair::runtime {
namespace {

constexpr hal::Duration kFirstRevivalDelay = std::chrono::milliseconds(100);
constexpr hal::Duration kMaxRevivalDelay = std::chrono::seconds(5);

/// A frame in flight for longer counts as a lost GPU. The painter detects most lost GPUs sooner;
/// this is the limit for drivers that report nothing, long enough for a software GPU under load.
constexpr hal::Duration kNeverReady = std::chrono::seconds(10);

/// Longest wait on the mailbox at a time.
constexpr hal::Duration kIdle = std::chrono::milliseconds(50);
/// Longest wait for the GPU at a time. The mailbox does not end it, so it delays a new frame.
constexpr hal::Duration kMaxWait = std::chrono::milliseconds(1);
/// The same while no other frame can be begun: it delays stop().
constexpr hal::Duration kMaxFullWait = std::chrono::milliseconds(2);
/// Pass times are copied for the status once in so many frames.
constexpr std::uint64_t kFramesPerPassTimes = 32;
constexpr hal::Duration kRevivalPoll = std::chrono::milliseconds(2);

hal::Error neverReady() {
  return {.kind = hal::ErrorKind::kDeviceLost,
          .subject = "GPU",
          .problem = "has not finished an image for 10 s",
          .remedy = {}};
}

constexpr std::array<std::string_view, 5> kStageNames{
    "delivery",    // from capture to arrival
    "mailbox",     // from arrival to the painter
    "issuing",     // tracking and issuing of the GPU's work
    "finishing",   // from there until the output frames are complete
    "until_ready"  // from capture until the output frames are complete
};

double ratio(hal::Duration part, hal::Duration whole) {
  return std::chrono::duration<double>(part) / std::chrono::duration<double>(whole);
}

}  // namespace

PaintStage::PaintStage(PainterFactory factory, const std::vector<OutputStage*>& outputs,
                       PaintStageOptions options, hal::Clock& clock, FrameLedger& ledger,
                       Mailbox<ArrivedFrame>& frames)
    : factory_(std::move(factory)),
      options_(options),
      clock_(clock),
      ledger_(ledger),
      frames_(frames),
      reviveAfter_(kFirstRevivalDelay),
      governor_(options.governor),
      latency_(options.latency) {
  assert(!outputs.empty());
  inFlight_.reserve(kMaxInFlight);
  for (OutputStage* output : outputs) outputs_.push_back({.stage = output});
}

PaintStage::~PaintStage() = default;

void PaintStage::start() {
  nextId_ = 0;
  painter_ = factory_();
  if (const auto opened = openOutputs(); !opened) {
    destroyPainter();
    throw hal::Failure(opened.error());
  }
  const std::scoped_lock lock(mutex_);
  hasPainter_ = true;
  isRenewing_ = isToRenew_;
}

bool PaintStage::step() {
  noteSuspension();
  handleRequests();
  followFormats();
  retireIfIdle();
  if (!painter_ && !revive()) return false;
  followLoans();
  bool didAnything = collect();
  const bool mayBegin = painter_ && !isToRenew_ && inFlight_.size() < kMaxInFlight;
  if (mayBegin) didAnything = paintNewest() || didAnything;
  busy_ = inFlight_.size();
  return didAnything;
}

/// After a jump of the clock the machine was suspended, so the GPU is not lost.
void PaintStage::noteSuspension() {
  constexpr hal::Duration kJump = std::chrono::seconds(1);
  const hal::TimePoint now = clock_.now();
  if (now - lastStep_ > kJump) resumedAt_ = now;
  lastStep_ = now;
}

bool PaintStage::collect() {
  bool tookAny = false;
  for (std::size_t i = 0; painter_ && i < outputs_.size(); ++i) {
    if (!outputs_[i].isOpen) continue;
    while (painter_ && outputs_[i].taken < inFlight_.size() && collectFor(outputs_[i])) {
      tookAny = true;
    }
  }
  removeFinished();
  if (!inFlight_.empty()) {
    const hal::TimePoint since = std::max(inFlight_.front().issued, resumedAt_);
    if (clock_.now() - since > kNeverReady) lose(neverReady());
  }
  return tookAny;
}

void PaintStage::removeFinished() {
  while (!inFlight_.empty() && inFlight_.front().pendingOutputs == 0) {
    finished(inFlight_.front(), clock_.now());
    inFlight_.erase(inFlight_.begin());
    for (Output& output : outputs_) {
      if (output.isOpen) --output.taken;
    }
  }
}

bool PaintStage::collectFor(Output& output) {
  const hal::Answer taken = painter_->poll(output.id, output.stage->buffer());
  if (taken.hasError()) {
    lose(taken.error());
    return false;
  }
  if (!taken.isYes()) return false;
  InFlight& frame = inFlight_.at(output.taken++);
  --frame.pendingOutputs;
  hal::Duration latency{};
  {
    const std::scoped_lock lock(mutex_);
    latency = latency_.latency();
  }
  output.stage->submit(frame.ticket, clock_.now(), latency);
  return true;
}

/// The larger of two shares: the painter's time for the frame of the frame period, and the time
/// since its arrival of the latency that the camera's delivery left.
double PaintStage::loadOf(const InFlight& frame, hal::TimePoint now) const {
  const hal::Duration cost = now - std::max(frame.began, lastFinished_);
  const hal::Duration left = frame.captured + latency_.latency() - frame.arrived;
  const double ofLatency = left > hal::Duration::zero() ? ratio(now - frame.arrived, left) : 2.0;
  return options_.framePeriod ? std::max(ratio(cost, *options_.framePeriod), ofLatency) : ofLatency;
}

void PaintStage::finished(const InFlight& frame, hal::TimePoint now) {
  const std::scoped_lock lock(mutex_);
  stages_.at(kFinishing).add(now - frame.issued, now);
  rate_.count(now);
  ++painted_;
  if (painter_ && painted_ % kFramesPerPassTimes == 0) {
    const auto times = painter_->passTimes();
    passes_.assign(times.begin(), times.end());  // in place: allocates for new passes only
  }
  if (frame.ticket) {
    stages_.at(kReady).add(now - frame.captured, now);
    load_ = loadOf(frame, now);
    governor_.painted(load_, frame.quality, now);
    latency_.ready(frame.captured + latency_.latency() - now, governor_.isLowest(), now);
  }
  lastFinished_ = now;
  reviveAfter_ = kFirstRevivalDelay;
}

bool PaintStage::paintNewest() {
  std::optional<ArrivedFrame> arrived = frames_.take();
  if (!arrived) return false;
  if (const auto painted = paint(*arrived); !painted) refuse(*arrived, painted.error());
  return true;
}

hal::Result<void> PaintStage::paint(const ArrivedFrame& arrived) {
  const hal::CapturedFrame& frame = arrived.frame;
  if (countOpen() == 0) {
    ledger_.end(arrived.ticket, Outcome::kOutputFailed);
    return {};
  }
  if (isSpared(clock_.now())) {
    ledger_.end(arrived.ticket, Outcome::kBlanked);
    return {};
  }
  lastBegun_ = clock_.now();
  const bool isRepeat = isPaused_ && held_;
  if (!isRepeat) hold(frame);
  InFlight painting{.ticket = arrived.ticket,
                    .captured = frame.captureTime,
                    .arrived = arrived.arrived,
                    .began = clock_.now(),
                    .pendingOutputs = countOpen()};
  {
    const std::scoped_lock lock(mutex_);
    painting.quality = governor_.level();
  }
  hal::CapturedFrame repeated = frame;
  if (isRepeat) repeated.image = held_->view();
  takeSurfaces();
  if (auto painted = painter_->paint(repeated, painting.quality); !painted) {
    giveSurfacesBack();
    return painted;
  }
  painting.issued = clock_.now();
  if (isRepeat) {
    ledger_.end(arrived.ticket, Outcome::kPaused);
    painting.ticket.reset();
  } else {
    ledger_.split(arrived.ticket, static_cast<int>(painting.pendingOutputs));
  }
  inFlight_.push_back(painting);
  const std::scoped_lock lock(mutex_);
  // In place: allocates only for a longer reason.
  if (const CameraPath* const path = painter_->cameraPath()) cameraPath_ = *path;
  stages_.at(kDelay).add(arrived.arrived - frame.captureTime, painting.began);
  stages_.at(kWaiting).add(painting.began - arrived.arrived, painting.began);
  stages_.at(kIssuing).add(painting.issued - painting.began, painting.issued);
  return {};
}

/// While all displays are switched off, and nothing else takes frames, they are painted only now
/// and then: what spans frames stays near to what the camera sees, and power is saved.
bool PaintStage::isSpared(hal::TimePoint now) const {
  constexpr hal::Duration kInterval = std::chrono::seconds(1);
  return now - lastBegun_ < kInterval && std::ranges::all_of(outputs_, [](const Output& each) {
           return !each.isOpen || each.stage->isBlanked();
         });
}

void PaintStage::hold(const hal::CapturedFrame& frame) {
  held_.reset();
  if (isPaused_) held_.emplace(frame.image);
}

void PaintStage::refuse(const ArrivedFrame& arrived, const hal::Error& error) {
  const bool isLost = error.kind == hal::ErrorKind::kDeviceLost;
  ledger_.end(arrived.ticket, isLost ? Outcome::kContextLost : Outcome::kNotPainted);
  if (isLost) {
    lose(error);
    return;
  }
  const std::scoped_lock lock(mutex_);
  ++failures_;
  failure_ = error;
}

/// Ends the frames in flight, for each output that has not got them.
void PaintStage::endInFlight(Outcome outcome) {
  for (const InFlight& frame : inFlight_) {
    for (std::size_t i = 0; frame.ticket && i < frame.pendingOutputs; ++i) {
      ledger_.end(*frame.ticket, outcome);
    }
  }
  inFlight_.clear();
  for (Output& output : outputs_) output.taken = 0;
}

void PaintStage::destroyPainter() {
  painter_.reset();
  for (Output& output : outputs_) output.isOpen = false;
}

/// Handles a lost GPU: destroys the painter and ends its frames.
void PaintStage::lose(const hal::Error& error) {
  destroyPainter();
  endInFlight(Outcome::kContextLost);
  reviveAt_ = clock_.now() + reviveAfter_;
  reviveAfter_ = std::min(2 * reviveAfter_, kMaxRevivalDelay);
  const std::scoped_lock lock(mutex_);
  ++contextLosses_;
  failure_ = error;
  hasPainter_ = false;
}

bool PaintStage::revive() {
  if (clock_.now() < reviveAt_) return false;
  try {
    start();
    return true;
  } catch (const hal::Failure& error) {
    reviveAt_ = clock_.now() + reviveAfter_;
    reviveAfter_ = std::min(2 * reviveAfter_, kMaxRevivalDelay);
    const std::scoped_lock lock(mutex_);
    failure_ = error.error();
    return false;
  }
}

void PaintStage::renew() {
  {
    const std::scoped_lock lock(mutex_);
    isRenewing_ = true;
  }
  isToRenew_ = true;
  wake();
}

void PaintStage::setFramePeriod(std::optional<hal::Duration> period) {
  const std::scoped_lock lock(mutex_);
  options_.framePeriod = period;
}

void PaintStage::limitQuality(std::size_t best) {
  const std::scoped_lock lock(mutex_);
  governor_.limit(best, clock_.now());
}

/// Destroys a painter that is to be replaced, once it has nothing in flight.
void PaintStage::retireIfIdle() {
  if (!isToRenew_ || (painter_ && !inFlight_.empty())) return;
  isToRenew_ = false;
  destroyPainter();
  reviveAt_ = clock_.now();
  const std::scoped_lock lock(mutex_);
  hasPainter_ = false;
}

void PaintStage::wait() {
  if (!painter_) {
    std::this_thread::sleep_for(kRevivalPoll);  // a frame in the mailbox would end a wait at once
  } else if (inFlight_.empty()) {
    frames_.wait(kIdle);
  } else {
    painter_->wait(inFlight_.size() < kMaxInFlight ? kMaxWait : kMaxFullWait);
  }
}

void PaintStage::stop() {
  endInFlight(Outcome::kStopped);
  if (const auto waiting = frames_.take()) ledger_.end(waiting->ticket, Outcome::kStopped);
  destroyPainter();
  busy_ = 0;
}

PaintStage::Progress PaintStage::progress() const {
  const std::scoped_lock lock(mutex_);
  return {.quality = governor_.level(),
          .painted = painted_,
          .hasPainter = hasPainter_,
          .isRenewing = isRenewing_};
}

PaintStage::Status PaintStage::status() const {
  const std::scoped_lock lock(mutex_);
  Status status{.quality = governor_.level(),
                .bestQuality = governor_.best(),
                .qualityLowered = governor_.lowered(),
                .qualityRaised = governor_.raised(),
                .latency = latency_.latency(),
                .configuredLatency = options_.latency.configured,
                .latencyRaised = latency_.raised(),
                .latencyLowered = latency_.lowered(),
                .painted = painted_,
                .failures = failures_,
                .contextLosses = contextLosses_,
                .hasPainter = hasPainter_,
                .isRenewing = isRenewing_,
                .failure = failure_,
                .perSecond = rate_.perSecond(clock_.now()),
                .load = load_,
                .passes = passes_,
                .cameraPath = cameraPath_};
  const hal::TimePoint now = clock_.now();
  status.stages.reserve(stages_.size());
  for (std::size_t i = 0; i < stages_.size(); ++i) {
    const RecentDurations& each = stages_.at(i);
    status.stages.push_back({kStageNames.at(i), each.recent(now), each.count(), each.sum()});
  }
  return status;
}

}  // namespace pleinair::runtime
