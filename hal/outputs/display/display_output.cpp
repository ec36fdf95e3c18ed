#include "hal/outputs/display/display_output.h"

#include <algorithm>
#include <cassert>
#include <cerrno>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "hal/outputs/display/display_errors.h"
#include "hal/outputs/display/modeset.h"
#include "hal/outputs/display/route.h"
#include "hal/outputs/display/shared_card.h"

namespace pleinair::hal {
namespace {

using namespace display;

/// One is shown, one waits for its refresh, and one is filled.
constexpr std::size_t kBuffers = 3;
constexpr Duration kFlipPatience = std::chrono::seconds(1);
constexpr Duration kCheckInterval = std::chrono::seconds(1);
constexpr Duration kRetryInterval = std::chrono::milliseconds(1);
constexpr std::size_t kPixelBytes = 4;
constexpr const char* kOtherConsole = "another console is in front";

class DisplayOutput final : public SurfaceOutput, private SurfaceUnmapper {
 public:
  DisplayOutput(std::string name, DisplaySettings settings, Cards& cards, const Clock& clock)
      : name_(std::move(name)), settings_(std::move(settings)), cards_(cards), clock_(clock) {}
  ~DisplayOutput() override { close(); }
  DisplayOutput(const DisplayOutput&) = delete;
  DisplayOutput& operator=(const DisplayOutput&) = delete;

  OutputIdentity identity() const override {
    return {.backend = std::string(kDisplayName),
            .id = route_ ? route_->connector.name : "display"};
  }

  Result<OutputFormat> start(const OutputRequest& request) override;
  Result<void> finish() override;
  Result<OutputFormat> reconfigure(const OutputRequest& request) override;
  Result<std::optional<Surface>> acquire() override;
  Result<SurfaceMapping> map(const Surface& surface) override;
  void release(const Surface& surface) override;
  Result<void> submit(const Surface& surface, Fence fence, TimePoint due) override;
  Result<void> takeEvents(std::vector<PresentationEvent>& events) override;
  std::optional<TimePoint> nextEvent() const override;
  const Suspension* suspension() const override { return suspension_ ? &*suspension_ : nullptr; }
  void noteActivity() override { cards_.noteActivity(clock_.now()); }

 private:
  enum class State { kFree, kLent, kQueued, kFlipping, kOnScreen };
  struct Buffer {
    ScanOutBuffer memory;
    Surface surface;
    State state = State::kFree;
    bool isMapped = false;
    bool hasRemains = false;  ///< of a picture that lay elsewhere
  };
  struct Queued {
    Buffer* buffer = nullptr;
    Fence fence;
    TimePoint due;
  };

  Card& card() const { return shared_->card(); }
  Result<void> makeBuffers();
  Result<void> setMode();
  Result<Mode> acceptedMode();
  int tryMode(const Mode& mode);
  void readTiming();
  Result<void> changeMode(const Mode& mode);
  OutputFormat place(FrameSize picture);
  void close();

  void unmap(SurfaceId surface) override {
    buffers_.at(static_cast<std::size_t>(surface)).isMapped = false;
  }
  Buffer& of(const Surface& surface) { return buffers_.at(static_cast<std::size_t>(surface.id)); }

  Result<void> advance();
  Result<void> takeFlips(TimePoint now);
  Result<void> checkConnection(TimePoint now);
  void flipped(const FlipEvent& flip);
  TimePoint commitTime(const Queued& queued) const;
  Result<void> flipNext(TimePoint now);
  void skipQueued(TimePoint now);
  void suspend(Suspension::Cause cause, std::string reason, TimePoint now);
  Result<void> resume(TimePoint now);
  Result<void> followConsole(TimePoint now);
  Result<void> followBlanking(TimePoint now);
  Result<void> switchOff(TimePoint now);
  bool isToBeOff(TimePoint now) const;
  std::string whoIsMaster() const;
  void end(Buffer& buffer, PresentationEvent::Result result, TimePoint time);
  std::uint64_t extended(std::uint32_t sequence);
  Error failure(int error, std::string problem) const;
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

  std::shared_ptr<SharedCard> shared_;
  std::optional<DisplayRoute> route_;
  std::optional<SavedCrtc> saved_;
  Mode chosen_;  ///< before the card was asked
  ObjectId modeBlob_ = 0;
  ObjectId flipProperty_ = 0;  ///< the plane's FB_ID
  PictureArea area_;
  std::vector<Buffer> buffers_;

  bool hasVblank_ = false;
  Duration period_{0};
  std::optional<TimePoint> phase_;  ///< a refresh
  std::vector<Queued> queue_;       ///< the earliest first
  Buffer* flipping_ = nullptr;
  Buffer* onScreen_ = nullptr;
  TimePoint committed_;
  TimePoint retryAt_;
  TimePoint checkAt_;
  std::uint64_t lastSequence_ = 0;
  std::vector<FlipEvent> flips_;
  std::vector<PresentationEvent> events_;

  std::optional<Suspension> suspension_;
  std::uint64_t yields_ = 0;     ///< timesYielded() when the mode was set
  TimePoint resumeAt_;           ///< when to ask for the master again
  bool isInBlankTimes_ = false;  ///< as of the last check
  Duration asleep_{0};           ///< Cards::timeSuspended() when the mode was set
};

Result<OutputFormat> DisplayOutput::start(const OutputRequest& request) {
  assert(!shared_);
  if (!isAcceptedSize(request.size)) return tl::unexpected(unusableSize());
  Result<ClaimedDisplay> claimed = claimDisplay(
      cards_, name_, {.connector = {}, .mode = settings_.mode, .framePeriod = request.framePeriod});
  if (!claimed) return tl::unexpected(claimed.error());
  shared_ = std::move(claimed->card);
  route_ = std::move(claimed->route);
  if (const auto set = setMode(); !set) return tl::unexpected(set.error());
  readTiming();
  return place(request.size);
}

/// Lays pictures of this size onto the display.
OutputFormat DisplayOutput::place(FrameSize picture) {
  const PictureArea before = area_;
  area_ = areaOf(picture, route_->mode.size, settings_.placement);
  for (Buffer& each : buffers_) {
    if (before != PictureArea() && before != area_) each.hasRemains = true;
    const std::size_t offset = static_cast<std::size_t>(area_.y) * each.memory.strideBytes +
                               static_cast<std::size_t>(area_.x) * kPixelBytes;
    each.surface.format = {.pixelFormat = PixelFormat::kRgba8, .size = area_.size, .encoding = {}};
    each.surface.planes[0] = {.dmaBuf = each.memory.dmaBuf,
                              .offsetBytes = offset,
                              .strideBytes = each.memory.strideBytes};
  }
  return OutputFormat{.frame = buffers_.front().surface.format,
                      .refresh = Refresh{.period = period_, .phase = phase_},
                      .quarterTurns = settings_.placement.quarterTurns};
}

Result<void> DisplayOutput::makeBuffers() {
  queue_.reserve(kBuffers);
  for (std::size_t i = 0; i < kBuffers; ++i) {
    Buffer buffer;
    const int failed = card().createBuffer(route_->mode.size, buffer.memory);
    if (failed != 0) {
      return tl::unexpected(errnoError(route_->connector.name,
                                       "has no memory for a picture of its size", -failed,
                                       "use a smaller mode"));
    }
    buffer.surface.id = SurfaceId{static_cast<std::uint32_t>(i)};
    buffer.surface.fourcc = kXrgb8888;
    buffers_.push_back(buffer);
  }
  return {};
}

/// Makes buffers of the mode's size and asks whether the card would show them. 0, or −errno.
int DisplayOutput::tryMode(const Mode& mode) {
  route_->mode = mode;
  for (const Buffer& each : buffers_) card().destroyBuffer(each.memory);
  buffers_.clear();
  if (modeBlob_ != 0) card().destroyBlob(std::exchange(modeBlob_, 0));
  if (const int failed = card().createBlob(mode.timings, modeBlob_); failed != 0) return failed;
  if (!makeBuffers()) return -ENOMEM;
  return shared_->commit(modesetChanges(*route_, modeBlob_, buffers_.front().memory.framebuffer),
                         Commit::kTest);
}

/// The chosen mode; where that was the program's choice and the card refuses it, the largest one
/// that it takes.
Result<Mode> DisplayOutput::acceptedMode() {
  const Mode chosen = route_->mode;
  int failed = tryMode(chosen);
  if (failed == 0) return chosen;
  if (settings_.mode == "auto" && (failed == -EINVAL || failed == -ENOMEM || failed == -ENOSPC)) {
    std::vector<Mode> others = route_->connector.modes;
    std::ranges::stable_sort(others, std::greater<>(),
                             [](const Mode& m) { return m.size.pixels(); });
    for (const Mode& each : others) {
      if (each.timings == chosen.timings || each.isInterlaced) continue;
      failed = tryMode(each);
      if (failed == 0) return each;
    }
  }
  return tl::unexpected(failure(failed, "refuses the mode " + chosen.name));
}

Result<void> DisplayOutput::setMode() {
  yields_ = timesYielded();
  if (shared_->takeMaster() != 0) return tl::unexpected(failure(-EACCES, "cannot be had"));
  if (buffers_.empty()) saved_ = card().saveCrtc(route_->crtc.id);
  chosen_ = route_->mode;
  const Result<Mode> mode = acceptedMode();
  if (!mode) return tl::unexpected(mode.error());
  route_->mode = *mode;
  const int failed = shared_->commit(
      modesetChanges(*route_, modeBlob_, buffers_.front().memory.framebuffer), Commit::kModeset);
  if (failed != 0) return tl::unexpected(failure(failed, "cannot set the mode " + mode->name));
  onScreen_ = &buffers_.front();
  onScreen_->state = State::kOnScreen;
  const Property* framebuffer = find(route_->plane.properties, "FB_ID");
  flipProperty_ = framebuffer == nullptr ? 0 : framebuffer->id;
  return {};
}

void DisplayOutput::readTiming() {
  period_ = route_->mode.period;
  hasVblank_ = card().hasVblank(route_->crtc.id);
  // Without vertical blanking, any instant will do for a refresh.
  if (!hasVblank_) phase_ = clock_.now();
  checkAt_ = clock_.now() + kCheckInterval;
  // Flips that an earlier output of this CRTC did not live to see.
  shared_->takeFlips(route_->crtc.id, flips_);
  flips_.clear();
  asleep_ = cards_.timeSuspended();
  if (cards_.lastActivity() == TimePoint{}) noteActivity();
}

void DisplayOutput::close() {
  if (!shared_) return;
  for ([[maybe_unused]] const Buffer& each : buffers_) assert(!each.isMapped);
  if (onScreen_ != nullptr && saved_) card().restore(*saved_);
  for (const Buffer& each : buffers_) card().destroyBuffer(each.memory);
  buffers_.clear();
  if (modeBlob_ != 0) card().destroyBlob(modeBlob_);
  if (route_) shared_->release(*route_);
  shared_.reset();
}

Result<OutputFormat> DisplayOutput::reconfigure(const OutputRequest& request) {
  assert(shared_);
  if (!isAcceptedSize(request.size)) return tl::unexpected(unusableSize());
  const TimePoint now = clock_.now();
  skipQueued(now);
  const Result<Mode> mode =
      chooseMode(route_->connector,
                 {.connector = {}, .mode = settings_.mode, .framePeriod = request.framePeriod});
  if (!mode) return tl::unexpected(mode.error());
  // The mode in force may be another than the one that was chosen, because that was refused.
  if (mode->timings != chosen_.timings) {
    if (const auto changed = changeMode(*mode); !changed) return tl::unexpected(changed.error());
  }
  return place(request.size);
}

Result<void> DisplayOutput::changeMode(const Mode& mode) {
  if (flipping_ != nullptr) {
    end(*std::exchange(flipping_, nullptr), PresentationEvent::Result::kSkipped, clock_.now());
  }
  onScreen_ = nullptr;
  route_->mode = mode;
  if (auto set = setMode(); !set) return set;
  suspension_.reset();  // a display that is to be off is switched off again
  readTiming();
  return {};
}

Result<void> DisplayOutput::finish() {
  assert(shared_);
  const Result<void> advanced = advance();
  if (onScreen_ != nullptr && saved_) card().restore(*std::exchange(saved_, std::nullopt));
  return advanced;
}

Result<std::optional<Surface>> DisplayOutput::acquire() {
  if (const auto advanced = advance(); !advanced) return tl::unexpected(advanced.error());
  if (suspension_) return std::nullopt;
  const auto free = std::ranges::find(buffers_, State::kFree, &Buffer::state);
  if (free == buffers_.end()) return std::nullopt;
  if (std::exchange(free->hasRemains, false)) {
    std::ranges::fill(free->memory.memory, std::uint8_t{0});
  }
  free->state = State::kLent;
  return free->surface;
}

Result<SurfaceMapping> DisplayOutput::map(const Surface& surface) {
  Buffer& buffer = of(surface);
  assert(buffer.state == State::kLent && !buffer.isMapped);
  buffer.isMapped = true;
  return SurfaceMapping(*this, surface.id,
                        {buffer.memory.memory.subspan(surface.planes[0].offsetBytes)});
}

void DisplayOutput::release(const Surface& surface) {
  Buffer& buffer = of(surface);
  assert(buffer.state == State::kLent && !buffer.isMapped);
  buffer.state = State::kFree;
}

Result<void> DisplayOutput::submit(const Surface& surface, Fence fence, TimePoint due) {
  Buffer& buffer = of(surface);
  assert(buffer.state == State::kLent && !buffer.isMapped);
  buffer.state = State::kQueued;
  queue_.push_back({.buffer = &buffer, .fence = std::move(fence), .due = due});
  return advance();
}

Result<void> DisplayOutput::takeEvents(std::vector<PresentationEvent>& events) {
  Result<void> advanced = advance();
  std::ranges::copy(events_, std::back_inserter(events));
  events_.clear();
  return advanced;
}

std::optional<TimePoint> DisplayOutput::nextEvent() const {
  const TimePoint now = clock_.now();
  if (!events_.empty()) return now;
  if (flipping_ != nullptr) {
    // The event follows the refresh; it is asked for again and again once that has passed.
    const TimePoint refresh = phase_ ? refreshAtOrAfter(committed_, *phase_, period_) : committed_;
    return std::max(refresh, now + kRetryInterval);
  }
  if (queue_.empty()) return std::nullopt;
  return std::max(commitTime(queue_.front()), std::max(retryAt_, now));
}

Result<void> DisplayOutput::advance() {
  const TimePoint now = clock_.now();
  if (auto taken = takeFlips(now); !taken) return taken;
  if (auto checked = checkConnection(now); !checked) return checked;
  if (auto followed = followConsole(now); !followed) return followed;
  if (auto followed = followBlanking(now); !followed) return followed;
  if (!suspension_) return flipNext(now);
  skipQueued(now);
  return {};
}

Result<void> DisplayOutput::takeFlips(TimePoint now) {
  flips_.clear();
  const int failed = shared_->takeFlips(route_->crtc.id, flips_);
  for (const FlipEvent& each : flips_) flipped(each);
  if (failed != 0) return tl::unexpected(failure(failed, "has gone"));
  const bool isOverdue = flipping_ != nullptr && now - committed_ > kFlipPatience;
  if (isOverdue && suspension_) {
    end(*std::exchange(flipping_, nullptr), PresentationEvent::Result::kSkipped, now);
  } else if (isOverdue) {
    return tl::unexpected(Error{.kind = ErrorKind::kDeviceLost,
                                .subject = route_->connector.name,
                                .problem = "has not shown a picture for a second",
                                .remedy = "its mode is set anew"});
  }
  return {};
}

/// Whether the display is still there.
Result<void> DisplayOutput::checkConnection(TimePoint now) {
  if (now < checkAt_) return {};
  checkAt_ = now + kCheckInterval;
  const Answer has = card().isStillConnected(route_->connector.id, route_->mode);
  if (has.hasError()) {
    shared_->markRemoved();
    return tl::unexpected(has.error());
  }
  isInBlankTimes_ =
      settings_.blanking.times && settings_.blanking.times->contain(cards_.timeOfDay());
  if (has.isYes()) return {};
  return tl::unexpected(Error{.kind = ErrorKind::kDeviceLost,
                              .subject = route_->connector.name,
                              .problem = "the display was unplugged, or has other modes now",
                              .remedy = {}});
}

void DisplayOutput::flipped(const FlipEvent& flip) {
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
std::uint64_t DisplayOutput::extended(std::uint32_t sequence) {
  const auto step =
      static_cast<std::uint32_t>(sequence - static_cast<std::uint32_t>(lastSequence_));
  lastSequence_ += step;
  return lastSequence_;
}

/// When to hand a surface to the card, so that it is shown at the refresh nearest to its due time.
TimePoint DisplayOutput::commitTime(const Queued& queued) const {
  const TimePoint earliest = queued.due - period_ / 2;
  // With vertical blanking the card waits for the refresh, else it shows the surface at once.
  return hasVblank_ ? earliest : refreshAtOrAfter(earliest, *phase_, period_);
}

void DisplayOutput::end(Buffer& buffer, PresentationEvent::Result result, TimePoint time) {
  buffer.state = State::kFree;
  events_.push_back(
      {.surface = buffer.surface.id, .result = result, .sequence = std::nullopt, .time = time});
}

/// Commits the newest of the surfaces whose refresh is next, up to the first that is not ready.
Result<void> DisplayOutput::flipNext(TimePoint now) {
  if (flipping_ != nullptr || now < retryAt_) return {};
  std::size_t ready = 0;
  while (ready < queue_.size() && commitTime(queue_[ready]) <= now &&
         queue_[ready].fence.hasSignalled()) {
    ++ready;
  }
  if (ready == 0) return {};
  for (; ready > 1; --ready) {
    end(*queue_.front().buffer, PresentationEvent::Result::kSuperseded, now);
    queue_.erase(queue_.begin());
  }
  Buffer& next = *queue_.front().buffer;
  const Change change{route_->plane.id, flipProperty_, next.memory.framebuffer};
  const int failed = shared_->commit({&change, 1}, Commit::kFlip);
  if (failed == -EBUSY) {
    // The flip before is not quite over.
    retryAt_ = now + kRetryInterval;
    return {};
  }
  queue_.erase(queue_.begin());
  if (failed == -EACCES) {
    end(next, PresentationEvent::Result::kSkipped, now);
    suspend(Suspension::Cause::kConsole, whoIsMaster(), now);
    return {};
  }
  if (failed == -ENOMEM) {
    end(next, PresentationEvent::Result::kSkipped, now);
    return {};
  }
  if (failed != 0) return tl::unexpected(failure(failed, "cannot show a picture"));
  next.state = State::kFlipping;
  flipping_ = &next;
  committed_ = now;
  return {};
}

void DisplayOutput::skipQueued(TimePoint now) {
  for (const Queued& each : queue_) end(*each.buffer, PresentationEvent::Result::kSkipped, now);
  queue_.clear();
}

/// Queued surfaces are not shown; one that is flipping may still be.
void DisplayOutput::suspend(Suspension::Cause cause, std::string reason, TimePoint now) {
  skipQueued(now);
  suspension_ = Suspension{.cause = cause, .reason = std::move(reason)};
  resumeAt_ = now;
}

std::string DisplayOutput::whoIsMaster() const {
  return areCardsYielded() ? kOtherConsole : notMaster(card().node(), {}).problem;
}

/// Sets the mode anew, with the last picture.
Result<void> DisplayOutput::resume(TimePoint now) {
  if (flipping_ != nullptr) {
    end(*std::exchange(flipping_, nullptr), PresentationEvent::Result::kSkipped, now);
  }
  const std::uint64_t yields = timesYielded();
  const Buffer& last = onScreen_ == nullptr ? buffers_.front() : *onScreen_;
  const int failed = shared_->commit(modesetChanges(*route_, modeBlob_, last.memory.framebuffer),
                                     Commit::kModeset);
  if (failed == -EBUSY) {  // the next call tries again
    if (!suspension_) suspend(Suspension::Cause::kConsole, "the card is busy", now);
    return {};
  }
  if (failed == -EACCES) {
    suspend(Suspension::Cause::kConsole, whoIsMaster(), now);
    return {};
  }
  if (failed != 0) return tl::unexpected(failure(failed, "cannot set the mode again"));
  suspension_.reset();
  yields_ = yields;
  readTiming();
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
    if (shared_->takeMaster() == 0) return resume(now);
    // To look who it is takes a while.
    if (suspension_->reason == kOtherConsole) suspension_->reason = whoIsMaster();
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
  return isToBe && !suspension_ && flipping_ == nullptr ? switchOff(now) : Result<void>();
}

Result<void> DisplayOutput::switchOff(TimePoint now) {
  const int failed = shared_->commit(switchOffChanges(*route_), Commit::kModeset);
  if (failed == -EBUSY) return {};
  if (failed == -EACCES) {
    suspend(Suspension::Cause::kConsole, whoIsMaster(), now);
    return {};
  }
  if (failed != 0) return tl::unexpected(failure(failed, "cannot be switched off"));
  const auto& after = settings_.blanking.after;
  const bool isByTime = !after || now - cards_.lastActivity() < *after;
  suspend(Suspension::Cause::kBlank,
          isByTime ? std::string("off at this time of day")
                   : "nothing has moved for " + durationText(*after),
          now);
  // Hours later, it must not be seen for the time of a frame.
  if (onScreen_ != nullptr) std::ranges::fill(onScreen_->memory.memory, std::uint8_t{0});
  return {};
}

Error DisplayOutput::failure(int error, std::string problem) const {
  const std::string& place = route_->connector.name;
  if (error == -EACCES || error == -EPERM) {
    if (areCardsYielded()) {
      return {.kind = ErrorKind::kBusy,
              .subject = place,
              .problem = kOtherConsole,
              .remedy = "go back to pleinair's: Ctrl+Alt+F1 … F12, or chvt"};
    }
    return notMaster(card().node(), place);
  }
  if (error == -ENODEV || error == -ENXIO || error == -EIO) {
    shared_->markRemoved();
    return {.kind = ErrorKind::kDeviceLost,
            .subject = card().node(),
            .problem = "the graphics card is gone",
            .remedy = {},
            .domain = ErrorDomain::kErrno,
            .code = -error};
  }
  Error other = errnoError(place, std::move(problem), -error);
  if (error == -EINVAL) other.kind = ErrorKind::kUnsupported;
  return other;
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
