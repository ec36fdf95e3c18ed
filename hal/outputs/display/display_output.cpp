#include "hal/outputs/display/display_output.h"

#include <algorithm>
#include <cassert>
#include <cerrno>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "hal/outputs/display/display_errors.h"
#include "hal/outputs/display/display_pipe.h"
#include "hal/outputs/display/flip_queue.h"
#include "hal/outputs/display/route.h"
#include "hal/outputs/display/shared_card.h"

namespace pleinair::hal {
namespace {

using namespace display;

constexpr Duration kCheckInterval = std::chrono::seconds(1);

/// The contract's side of a display: its life, whether it is plugged in, and why it shows nothing
/// for now. DisplayPipe sets the mode, FlipQueue times the pictures.
class DisplayOutput final : public SurfaceOutput, private SurfaceUnmapper {
 public:
  DisplayOutput(std::string name, DisplaySettings settings, Cards& cards, const Clock& clock)
      : name_(std::move(name)),
        settings_(std::move(settings)),
        cards_(cards),
        clock_(clock),
        dimmer_(settings_.dimming) {}

  OutputIdentity identity() const override {
    return {.backend = std::string(kDisplayName),
            .id = pipe_ ? pipe_->connector().name : "display"};
  }

  Result<OutputFormat> start(const OutputRequest& request) override;
  Result<void> finish() override;
  Result<OutputFormat> reconfigure(const OutputRequest& request) override;
  Result<std::optional<Surface>> acquire() override;
  Result<SurfaceMapping> map(const Surface& surface) override;
  void release(const Surface& surface) override;
  Result<void> submit(const Surface& surface, Fence fence, TimePoint due) override;
  Result<void> takeEvents(std::vector<PresentationEvent>& events) override;
  Result<std::vector<GpuSurface>> lendToGpu(std::span<const std::uint64_t> modifiers,
                                            std::size_t count) override;
  Result<std::optional<SurfaceId>> acquireForGpu() override;
  Result<Image> copyOfGpuSurface(SurfaceId surface, bool isWholeBuffer) override;
  void endLending() override { pipe_->retireGpuBuffers(); }
  std::optional<TimePoint> nextEvent() const override { return flips_->nextEvent(); }
  const Suspension* suspension() const override { return suspension_ ? &*suspension_ : nullptr; }
  double brightness() const override { return dimmer_.level(clock_.now()); }
  void noteActivity() override { cards_.noteActivity(clock_.now()); }

 private:
  using State = DisplayBuffer::State;

  Result<void> setMode(const Mode& mode);
  void noteModeset();
  OutputFormat place(FrameSize picture);

  void unmap(SurfaceId surface) override { bufferOf(surface).isMapped = false; }
  DisplayBuffer* gpuBufferOf(SurfaceId surface);
  DisplayBuffer& bufferOf(SurfaceId surface) {
    DisplayBuffer* const gpu = gpuBufferOf(surface);
    return gpu != nullptr ? *gpu : pipe_->buffers().at(static_cast<std::size_t>(surface));
  }

  Result<void> advance();
  Result<void> takeFlips(TimePoint now);
  Result<void> checkConnection(TimePoint now);
  Result<void> flipNext(TimePoint now);
  void suspend(Suspension::Cause cause, std::string reason, TimePoint now);
  Result<void> resume(TimePoint now);
  Result<void> followConsole(TimePoint now);
  Result<void> followBlanking(TimePoint now);
  Result<void> switchOff(TimePoint now);
  bool isToBeOff(TimePoint now) const;
  Error noGpuSurface() const {
    return {.kind = ErrorKind::kUnsupported,
            .subject = name_,
            .problem = "lends this surface to no processor, or not any more",
            .remedy = {}};
  }
  Error unusableSize() const {
    return {.kind = ErrorKind::kUnsupported,
            .subject = name_,
            .problem = "cannot take this size",
            .remedy = "use 1 to 8192 px a side and at most 64 Mpx"};
  }

  std::string name_;
  DisplaySettings settings_;
  Cards& cards_;
  const Clock& clock_;
  Dimmer dimmer_;

  std::optional<DisplayPipe> pipe_;
  std::optional<FlipQueue> flips_;
  TimePoint checkAt_;
  TimePoint driftsSince_;

  std::optional<Suspension> suspension_;
  std::uint64_t yields_ = 0;     ///< timesYielded() when the mode was set
  TimePoint resumeAt_;           ///< when to ask for the master again
  bool isInBlankTimes_ = false;  ///< as of the last check
  Duration asleep_{0};           ///< Cards::timeSuspended() when the mode was set
};

Result<OutputFormat> DisplayOutput::start(const OutputRequest& request) {
  assert(!pipe_);
  if (!isAcceptedSize(request.size)) return tl::unexpected(unusableSize());
  Result<ClaimedDisplay> claimed = claimDisplay(
      cards_, name_, {.connector = {}, .mode = settings_.mode, .framePeriod = request.framePeriod});
  if (!claimed) return tl::unexpected(claimed.error());
  const Mode mode = claimed->route.mode;
  pipe_.emplace(*std::move(claimed), settings_.mode == "auto", settings_.driftPixels);
  driftsSince_ = clock_.now();
  dimmer_.follow(cards_.timeOfDay(), clock_.now());
  flips_.emplace(*pipe_, clock_);
  if (const auto set = setMode(mode); !set) return tl::unexpected(set.error());
  return place(request.size);
}

Result<void> DisplayOutput::setMode(const Mode& mode) {
  yields_ = timesYielded();
  if (auto set = pipe_->setMode(mode); !set) return set;
  flips_->begin(pipe_->buffers().front());
  noteModeset();
  return {};
}

void DisplayOutput::noteModeset() {
  checkAt_ = clock_.now() + kCheckInterval;
  asleep_ = cards_.timeSuspended();
  if (cards_.lastActivity() == TimePoint{}) noteActivity();
}

/// Lays pictures of this size onto the display.
OutputFormat DisplayOutput::place(FrameSize picture) {
  pipe_->place(picture, settings_.placement);
  return OutputFormat{.frame = pipe_->buffers().front().surface.format,
                      .refresh = flips_->refresh(),
                      .quarterTurns = settings_.placement.quarterTurns};
}

Result<OutputFormat> DisplayOutput::reconfigure(const OutputRequest& request) {
  assert(pipe_);
  if (!isAcceptedSize(request.size)) return tl::unexpected(unusableSize());
  const TimePoint now = clock_.now();
  flips_->skipQueued(now);
  pipe_->retireGpuBuffers();
  const Result<Mode> mode =
      chooseMode(pipe_->connector(),
                 {.connector = {}, .mode = settings_.mode, .framePeriod = request.framePeriod});
  if (!mode) return tl::unexpected(mode.error());
  // The mode in force may be another than the requested one, because that was refused.
  if (mode->timings != pipe_->requestedMode().timings) {
    flips_->skipFlipping(now);
    if (auto set = setMode(*mode); !set) return tl::unexpected(set.error());
    suspension_.reset();  // a display that is to be off is switched off again
  }
  return place(request.size);
}

Result<void> DisplayOutput::finish() {
  assert(pipe_);
  const Result<void> advanced = advance();
  pipe_->restore();
  return advanced;
}

Result<std::optional<Surface>> DisplayOutput::acquire() {
  if (const auto advanced = advance(); !advanced) return tl::unexpected(advanced.error());
  pipe_->destroyRetired();
  if (suspension_) return std::nullopt;
  std::vector<DisplayBuffer>& buffers = pipe_->buffers();
  const auto free = std::ranges::find(buffers, State::kFree, &DisplayBuffer::state);
  if (free == buffers.end()) return std::nullopt;
  if (std::exchange(free->hasRemains, false)) {
    std::ranges::fill(free->memory.memory, std::uint8_t{0});
  }
  free->state = State::kLent;
  return free->surface;
}

DisplayBuffer* DisplayOutput::gpuBufferOf(SurfaceId surface) {
  for (const auto& each : pipe_->gpuBuffers()) {
    if (each->surface.id == surface) return each.get();
  }
  return nullptr;
}

Result<std::vector<GpuSurface>> DisplayOutput::lendToGpu(std::span<const std::uint64_t> modifiers,
                                                         std::size_t count) {
  if (!settings_.lendsToGpu) {
    return tl::unexpected(Error{.kind = ErrorKind::kUnsupported,
                                .subject = name_,
                                .problem = "is set to copy pictures (scan_out)",
                                .remedy = {}});
  }
  if (auto made = pipe_->makeGpuBuffers(modifiers, count); !made) {
    return tl::unexpected(made.error());
  }
  std::vector<GpuSurface> surfaces;
  for (const auto& each : pipe_->gpuBuffers()) {
    if (!each->isRetired) surfaces.push_back(pipe_->gpuSurface(*each));
  }
  return surfaces;
}

Result<std::optional<SurfaceId>> DisplayOutput::acquireForGpu() {
  if (const auto advanced = advance(); !advanced) return tl::unexpected(advanced.error());
  if (flips_->takeGpuRefusal()) {
    pipe_->retireGpuBuffers();
    return tl::unexpected(Error{.kind = ErrorKind::kUnsupported,
                                .subject = pipe_->connector().name,
                                .problem = "has refused to show what the GPU drew",
                                .remedy = {}});
  }
  if (suspension_) return std::nullopt;
  for (const auto& each : pipe_->gpuBuffers()) {
    if (each->isRetired || each->state != State::kFree) continue;
    each->state = State::kLent;
    return each->surface.id;
  }
  return std::nullopt;
}

Result<Image> DisplayOutput::copyOfGpuSurface(SurfaceId surface, bool isWholeBuffer) {
  const DisplayBuffer* const buffer = gpuBufferOf(surface);
  if (buffer == nullptr) return tl::unexpected(noGpuSurface());
  const FrameSize all = pipe_->canvasSize();
  std::vector<std::uint8_t> bytes(static_cast<std::size_t>(all.pixels()) * 4);
  if (const int failed = pipe_->card().readGpuBuffer(*buffer->gpu, all, bytes); failed != 0) {
    Error error = pipe_->failure(failed, "cannot read back what the GPU drew");
    if (error.kind != ErrorKind::kDeviceLost) error.kind = ErrorKind::kUnsupported;
    return tl::unexpected(std::move(error));
  }
  const GpuSurface drawn = pipe_->gpuSurface(*buffer);
  const FrameSize size = isWholeBuffer ? all : drawn.surface.format.size;
  const int left = isWholeBuffer ? 0 : drawn.x;
  const int top = isWholeBuffer ? 0 : drawn.y;
  Image image({.pixelFormat = PixelFormat::kRgba8, .size = size, .encoding = {}});
  for (int y = 0; y < size.height; ++y) {
    const std::size_t begin =
        (static_cast<std::size_t>(top + y) * static_cast<std::size_t>(all.width) +
         static_cast<std::size_t>(left)) *
        4;
    const std::span<std::uint8_t> row = image.row(0, y);
    for (std::size_t i = 0; i + 4 <= row.size(); i += 4) {
      row[i] = bytes[begin + i + 2];
      row[i + 1] = bytes[begin + i + 1];
      row[i + 2] = bytes[begin + i];
      row[i + 3] = 255;
    }
  }
  return image;
}

Result<SurfaceMapping> DisplayOutput::map(const Surface& surface) {
  if (gpuBufferOf(surface.id) != nullptr) return tl::unexpected(noGpuSurface());
  DisplayBuffer& buffer = bufferOf(surface.id);
  assert(buffer.state == State::kLent && !buffer.isMapped);
  buffer.isMapped = true;
  return SurfaceMapping(*this, surface.id,
                        {buffer.memory.memory.subspan(surface.planes[0].offsetBytes)});
}

void DisplayOutput::release(const Surface& surface) {
  DisplayBuffer& buffer = bufferOf(surface.id);
  assert(buffer.state == State::kLent && !buffer.isMapped);
  buffer.state = State::kFree;
}

Result<void> DisplayOutput::submit(const Surface& surface, Fence fence, TimePoint due) {
  flips_->push(bufferOf(surface.id), std::move(fence), due);
  return advance();
}

Result<void> DisplayOutput::takeEvents(std::vector<PresentationEvent>& events) {
  Result<void> advanced = advance();
  flips_->takeEvents(events);
  return advanced;
}

Result<void> DisplayOutput::advance() {
  const TimePoint now = clock_.now();
  if (auto taken = takeFlips(now); !taken) return taken;
  if (auto checked = checkConnection(now); !checked) return checked;
  if (auto followed = followConsole(now); !followed) return followed;
  if (auto followed = followBlanking(now); !followed) return followed;
  if (!suspension_) return flipNext(now);
  flips_->skipQueued(now);
  return {};
}

Result<void> DisplayOutput::takeFlips(TimePoint now) {
  const int failed = flips_->takeFlips();
  if (failed != 0) return tl::unexpected(pipe_->failure(failed, "has gone"));
  if (!flips_->isOverdue(now)) return {};
  if (suspension_) {
    flips_->skipFlipping(now);
    return {};
  }
  return tl::unexpected(Error{.kind = ErrorKind::kDeviceLost,
                              .subject = pipe_->connector().name,
                              .problem = "has not shown a picture for a second",
                              .remedy = "its mode is set anew"});
}

/// Whether the display is still there.
Result<void> DisplayOutput::checkConnection(TimePoint now) {
  if (now < checkAt_) return {};
  checkAt_ = now + kCheckInterval;
  const Answer has = pipe_->card().isStillConnected(pipe_->connector().id, pipe_->mode());
  if (has.hasError()) {
    pipe_->shared().markRemoved();
    return tl::unexpected(has.error());
  }
  flips_->followRefresh();
  pipe_->panTo(static_cast<std::uint64_t>((now - driftsSince_) / DisplaySettings::kDriftInterval));
  const std::optional<Duration> time = cards_.timeOfDay();
  dimmer_.follow(time, now);
  isInBlankTimes_ = time && settings_.blanking.times && settings_.blanking.times->contain(*time);
  if (has.isYes()) return {};
  return tl::unexpected(Error{.kind = ErrorKind::kDeviceLost,
                              .subject = pipe_->connector().name,
                              .problem = "the display was unplugged, or has other modes now",
                              .remedy = {}});
}

Result<void> DisplayOutput::flipNext(TimePoint now) {
  const int failed = flips_->commitNext(now);
  if (failed == -EACCES) {
    suspend(Suspension::Cause::kConsole, pipe_->whoIsMaster(), now);
    return {};
  }
  if (failed != 0) return tl::unexpected(pipe_->failure(failed, "cannot show a picture"));
  return {};
}

/// Queued surfaces are not shown; one that is flipping may still be.
void DisplayOutput::suspend(Suspension::Cause cause, std::string reason, TimePoint now) {
  flips_->skipQueued(now);
  suspension_ = Suspension{.cause = cause, .reason = std::move(reason)};
  resumeAt_ = now;
}

/// Sets the mode anew, with the last picture.
Result<void> DisplayOutput::resume(TimePoint now) {
  flips_->skipFlipping(now);
  const std::uint64_t yields = timesYielded();
  const int failed = pipe_->setModeAgain(*flips_->onScreen());
  if (failed == -EBUSY) {  // the next call tries again
    if (!suspension_) suspend(Suspension::Cause::kConsole, "the card is busy", now);
    return {};
  }
  if (failed == -EACCES) {
    suspend(Suspension::Cause::kConsole, pipe_->whoIsMaster(), now);
    return {};
  }
  if (failed != 0) return tl::unexpected(pipe_->failure(failed, "cannot set the mode again"));
  suspension_.reset();
  yields_ = yields;
  flips_->readTiming();
  noteModeset();
  return {};
}

/// Suspends while another console is in front, or another program is the master. A computer that
/// was suspended may have forgotten the mode.
Result<void> DisplayOutput::followConsole(TimePoint now) {
  const bool isAway = areCardsYielded();
  const auto isConsole = [this] {
    return suspension_ && suspension_->cause == Suspension::Cause::kConsole;
  };
  // One may have come to the front and gone since the last call.
  if (!isConsole() && (isAway || yields_ != timesYielded())) {
    suspend(Suspension::Cause::kConsole, kOtherConsole, now);
  }
  if (isConsole()) {
    if (isAway || now < resumeAt_) return {};
    resumeAt_ = now + kCheckInterval;
    if (pipe_->shared().takeMaster() == 0) return resume(now);
    // To look who it is takes a while.
    if (suspension_->reason == kOtherConsole) suspension_->reason = pipe_->whoIsMaster();
    return {};
  }
  constexpr Duration kNap = std::chrono::milliseconds(500);
  const bool hasSlept = cards_.timeSuspended() - asleep_ > kNap;
  return hasSlept && !suspension_ ? resume(now) : Result<void>();
}

bool DisplayOutput::isToBeOff(TimePoint now) const {
  return settings_.blanking.isOff(isInBlankTimes_, now - cards_.lastActivity());
}

Result<void> DisplayOutput::followBlanking(TimePoint now) {
  const bool isOff = suspension_ && suspension_->cause == Suspension::Cause::kBlank;
  const bool isToBe = isToBeOff(now);
  if (isOff) return isToBe ? Result<void>() : resume(now);
  // A flip in progress is waited for.
  return isToBe && !suspension_ && !flips_->isFlipping() ? switchOff(now) : Result<void>();
}

Result<void> DisplayOutput::switchOff(TimePoint now) {
  const int failed = pipe_->switchOff();
  if (failed == -EBUSY) return {};
  if (failed == -EACCES) {
    suspend(Suspension::Cause::kConsole, pipe_->whoIsMaster(), now);
    return {};
  }
  if (failed != 0) return tl::unexpected(pipe_->failure(failed, "cannot be switched off"));
  const auto& after = settings_.blanking.after;
  const bool isByTime = !after || now - cards_.lastActivity() < *after;
  suspend(Suspension::Cause::kBlank,
          isByTime ? std::string("off at this time of day")
                   : "nothing has moved for " + durationText(*after),
          now);
  flips_->blackenScreen();  // hours later, it must not be seen for the time of a frame
  return {};
}

}  // namespace

void leaveConsole() {
  yieldCards();
}

void enterConsole() {
  regainCards();
}

Result<std::unique_ptr<SurfaceOutput>> openDisplay(const std::string& name,
                                                   const DisplaySettings& settings, Cards& cards,
                                                   const Clock& clock) {
  if (!isDisplayName(name)) {
    return tl::unexpected(Error{.kind = ErrorKind::kInvalidArgument,
                                .subject = name,
                                .problem = "names no display",
                                .remedy = "give display, display:HDMI-A-1 or "
                                          "display:card1-HDMI-A-1"});
  }
  return std::make_unique<DisplayOutput>(name, settings, cards, clock);
}

}  // namespace pleinair::hal
