#include "pipeline/runtime/paint_stage.h"

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

void PaintStage::add(OutputStage& output) {
  {
    const std::scoped_lock lock(mutex_);
    toOpen_.push_back(&output);
  }
  wake();
}

void PaintStage::remove(OutputStage& output) {
  {
    const std::scoped_lock lock(mutex_);
    assert(std::ranges::find(toClose_, &output) == toClose_.end());
    toClose_.push_back(&output);
  }
  wake();
}

bool PaintStage::hasReleased(const OutputStage& output) const {
  const std::scoped_lock lock(mutex_);
  return std::ranges::find(toOpen_, &output) == toOpen_.end() &&
         std::ranges::find(toClose_, &output) == toClose_.end();
}

void PaintStage::handleRequests() {
  std::vector<OutputStage*> toOpen;
  std::vector<OutputStage*> toClose;
  {
    const std::scoped_lock lock(mutex_);
    if (toOpen_.empty() && toClose_.empty()) return;
    toOpen = toOpen_;
    toClose = toClose_;
  }
  for (OutputStage* output : toOpen) outputs_.push_back({.stage = output, .format = {}});
  for (OutputStage* output : toClose) close(*output);
  const std::scoped_lock lock(mutex_);
  std::erase_if(toOpen_,
                [&](auto* each) { return std::ranges::find(toOpen, each) != toOpen.end(); });
  std::erase_if(toClose_,
                [&](auto* each) { return std::ranges::find(toClose, each) != toClose.end(); });
  // Under the lock, because once it is free, hasReleased() is true and the output may be destroyed.
  for (OutputStage* output : toClose) output->wake();
}

/// Opens the outputs that are not open in the painter. One that it cannot paint for, and that is
/// opened again by itself, fails, and the others go on. Errors: kDeviceLost; why one is not open
/// that is not opened again, or where no other is open.
hal::Result<void> PaintStage::openOutputs() {
  std::vector<std::pair<const Output*, hal::Error>> refused;
  for (Output& output : outputs_) {
    if (output.isOpen || output.stage->isRefused()) continue;
    output.format = output.stage->format();
    try {
      painter_->open(nextId_, output.format);
    } catch (const hal::Failure& error) {
      const bool isLost = error.error().kind == hal::ErrorKind::kDeviceLost;
      if (isLost || !output.stage->reopens()) return tl::unexpected(error.error());
      refused.emplace_back(&output, error.error());
      continue;
    }
    output.id = nextId_++;
    output.isOpen = true;
    output.taken = inFlight_.size();
    offer(output);
  }
  if (!refused.empty() && countOpen() == 0) return tl::unexpected(refused.front().second);
  for (const auto& [output, error] : refused) output->stage->refuse(output->format, error);
  return {};
}

std::size_t PaintStage::countOpen() const {
  return static_cast<std::size_t>(std::ranges::count_if(outputs_, &Output::isOpen));
}

/// The painter's imports belong to one opening of the output.
void PaintStage::offer(const Output& output) {
  output.stage->lending().offer(painter_->drawable());
  output.stage->wake();
}

/// Draws the pattern into surfaces that were lent.
void PaintStage::followLoans() {
  for (const Output& output : outputs_) {
    if (!painter_) return;
    if (!output.isOpen) continue;
    SurfaceLending& lending = output.stage->lending();
    const std::shared_ptr<const SurfaceLoan> loan = lending.toImport();
    // Of a stream that the painter has not been opened for yet.
    if (!loan || loan->surfaces.front().surface.format.size != output.format.frame.size) continue;
    const hal::Result<void> drawn = painter_->importLoan(output.id, *loan);
    if (!drawn && drawn.error().kind == hal::ErrorKind::kTimeout) continue;
    lending.imported(loan->number, drawn);
    output.stage->wake();
    if (!drawn && drawn.error().kind == hal::ErrorKind::kDeviceLost) lose(drawn.error());
  }
}

void PaintStage::takeSurfaces() {
  taken_.clear();
  for (const Output& output : outputs_) {
    if (!output.isOpen) continue;
    if (const auto surface = output.stage->takeSurface()) {
      taken_.emplace_back(output.stage, *surface);
      painter_->drawNextInto(output.id, *surface);
    }
  }
}

/// The frame was not painted.
void PaintStage::giveSurfacesBack() {
  for (const auto& [stage, surface] : taken_) stage->lending().giveBack(surface);
}

/// Ends the frames in flight that an output has not got, and closes it.
void PaintStage::closeInPainter(Output& output) {
  if (!std::exchange(output.isOpen, false)) return;
  for (std::size_t i = output.taken; i < inFlight_.size(); ++i) {
    if (inFlight_[i].ticket) ledger_.end(*inFlight_[i].ticket, Outcome::kStopped);
    --inFlight_[i].pendingOutputs;
  }
  if (painter_) painter_->close(output.id);
}

void PaintStage::close(OutputStage& output) {
  const auto closed = std::ranges::find(outputs_, &output, &Output::stage);
  if (closed == outputs_.end()) return;
  closeInPainter(*closed);
  outputs_.erase(closed);
}

/// Outputs that were opened again may want other pictures than before.
void PaintStage::followFormats() {
  if (!painter_) return;  // the next one is opened with the formats of that time
  for (Output& output : outputs_) {
    const hal::OutputFormat format = output.stage->format();
    const bool isSame =
        format.frame == output.format.frame && format.quarterTurns == output.format.quarterTurns;
    if (!isSame) closeInPainter(output);
  }
  if (const auto opened = openOutputs(); !opened) lose(opened.error());
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
