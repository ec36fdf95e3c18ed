#include "hal/supervisor/camera_supervisor.h"

#include <algorithm>
#include <utility>

#include "hal/clock.h"
#include "hal/overloaded.h"

namespace pleinair::hal {
namespace {

bool isSame(const StreamFormat& a, const StreamFormat& b) {
  return a.frame == b.frame && a.framePeriod == b.framePeriod && a.frameCount == b.frameCount &&
         a.warning == b.warning;
}

}  // namespace

std::string_view toString(CameraState state) {
  switch (state) {
    case CameraState::kOpening:
      return "opening";
    case CameraState::kStreaming:
      return "streaming";
    case CameraState::kStalled:
      return "stalled";
    case CameraState::kLost:
      return "lost";
    case CameraState::kBackingOff:
      return "backing off";
    case CameraState::kEnded:
      return "ended";
  }
  return "";
}

CameraSupervisor::CameraSupervisor(CameraSelector& selector, Clock& clock,
                                   SupervisorOptions options, StreamRequest request)
    : selector_(selector),
      clock_(clock),
      options_(options),
      request_(request),
      backOff_(options.backOff),
      watchdog_(options.watchdog, options.maxPollInterval) {
  enter(CameraState::kOpening, "opens " + selector_.choice());
}

CameraSupervisor::~CameraSupervisor() {
  close();
}

SupervisedNext CameraSupervisor::next(TimePoint deadline) {
  SupervisedNext next = advance(deadline);
  publishCounts();
  return next;
}

SupervisedNext CameraSupervisor::advance(TimePoint deadline) {
  for (;;) {
    if (isStopped_ && state_ != CameraState::kEnded) {
      close();
      end("stopped by the program");
    }
    if (auto pending = takePending()) return std::move(*pending);
    if (state_ == CameraState::kEnded) return EndOfStream{truncated_};
    noteDeviceChange();
    step(deadline);
    const bool isWoken = takeWake();
    if (isStopped_ || !pending_.empty()) continue;
    if (isWoken || clock_.now() >= deadline) return CameraTimeout{};
  }
}

std::optional<SupervisedNext> CameraSupervisor::takePending() {
  if (pending_.empty()) return std::nullopt;
  SupervisedNext next = std::move(pending_[handedOut_++]);
  if (handedOut_ == pending_.size()) {
    pending_.clear();
    handedOut_ = 0;
  }
  return next;
}

void CameraSupervisor::enter(CameraState state, std::string reason, std::optional<Error> cause) {
  state_ = state;
  pending_.emplace_back(CameraStateChanged{
      .state = state, .reason = reason, .camera = camera_, .cause = std::move(cause)});
  const std::scoped_lock lock(mutex_);
  status_.state = state;
  status_.reason = std::move(reason);
  status_.camera = camera_;
}

void CameraSupervisor::announce(const StreamFormat& format) {
  if (announced_ && isSame(*announced_, format)) return;
  announced_ = format;
  pending_.emplace_back(FormatChanged{format});
}

void CameraSupervisor::step(TimePoint deadline) {
  switch (state_) {
    case CameraState::kOpening:
      if (!opened_) {
        open();
        return;
      }
      [[fallthrough]];
    case CameraState::kStreaming:
    case CameraState::kStalled:
      pollCamera(deadline);
      return;
    case CameraState::kLost:
      closeAndBackOff();
      return;
    case CameraState::kBackingOff:
      backOff(deadline);
      return;
    case CameraState::kEnded:
      return;
  }
}

void CameraSupervisor::open() {
  Result<OpenedCamera> opened = selector_.open(request_);
  if (!opened) {
    ++counts_.openFailures;
    std::string reason = "cannot open a camera: " + opened.error().message();
    lose(std::move(reason), std::move(opened.error()));
    return;
  }
  ++counts_.opens;
  opened_ = std::move(*opened);
  camera_ = opened_->camera->identity();
  startedAt_ = clock_.now();
  watchdog_.expect(opened_->format.framePeriod);
  watchdog_.frameCame(startedAt_);
  frames_.beginSession(opened_->isDevice);
  framesBeforeSilence_ = frames_.counts();
  announce(opened_->format);
}

void CameraSupervisor::close() {
  if (!opened_) return;
  opened_->camera->stop();
  opened_.reset();
}

void CameraSupervisor::pollCamera(TimePoint deadline) {
  const TimePoint until = std::min(deadline, clock_.now() + options_.maxPollInterval);
  NextFrame next = opened_->camera->next(until);
  std::visit(Overloaded{
                 [&](CapturedFrame& frame) { receive(std::move(frame)); },
                 [&](CameraTimeout&) {
                   if (clock_.now() < until)
                     clock_.sleepUntil(until, wakeToken());  // it returned early
                   noteSilence();
                 },
                 [&](FormatChanged& changed) {
                   watchdog_.expect(changed.format.framePeriod);
                   announce(changed.format);
                 },
                 [&](EndOfStream& ending) { receiveEnd(std::move(ending)); },
                 [&](CameraLost& lost) {
                   std::string reason = "is gone: " + lost.cause.message();
                   lose(std::move(reason), std::move(lost.cause));
                 },
                 [&](Error& error) {
                   ++counts_.errors;
                   std::string reason = "failed: " + error.message();
                   lose(std::move(reason), std::move(error));
                 },
             },
             next);
}

void CameraSupervisor::receive(CapturedFrame frame) {
  auto taken = frames_.take(std::move(frame), clock_.now(), state_ == CameraState::kStalled);
  if (auto* supervised = std::get_if<SupervisedFrame>(&taken)) {
    deliver(std::move(*supervised));
  } else {
    noteSilence();
  }
}

void CameraSupervisor::receiveEnd(EndOfStream ending) {
  if (opened_->isDevice) {
    lose("ended its stream", std::move(ending.truncated));
    return;
  }
  close();
  std::string reason = ending.truncated ? "broke off: " + ending.truncated->message()
                                        : std::string("came to its end");
  end(std::move(reason), std::move(ending.truncated));
}

void CameraSupervisor::deliver(SupervisedFrame frame) {
  const TimePoint now = clock_.now();
  StreamFormat format = *announced_;
  format.frame = frame.frame.image.format;
  announce(format);  // if the back end did not
  if (state_ == CameraState::kOpening) {
    streamingSince_ = now;
    selector_.wasOfUse(*camera_);
    enter(CameraState::kStreaming,
          "gave its first frame " + durationText(now - startedAt_) + " after its start");
  } else if (state_ == CameraState::kStalled) {
    watchdog_.nothingCame(now);
    ++counts_.resumptions;
    enter(CameraState::kStreaming, "gives frames again after " + durationText(watchdog_.silence()) +
                                       " of silence; " + std::to_string(frame.lostInStall) +
                                       " were lost");
  }
  watchdog_.frameCame(now);
  framesBeforeSilence_ = frames_.counts();
  pending_.emplace_back(std::move(frame));
}

void CameraSupervisor::noteSilence() {
  watchdog_.nothingCame(clock_.now());
  if (!opened_->isDevice || opened_->format.isTriggered) return;
  if (state_ == CameraState::kOpening) {
    if (watchdog_.silence() < options_.firstFrameLimit) return;
    selector_.putLast(*camera_);
    lose(silenceText() + " since its start");
  } else if (state_ == CameraState::kStreaming) {
    if (!watchdog_.isBeyondLimit()) return;
    ++counts_.stalls;
    enter(CameraState::kStalled, silenceText());
  } else if (watchdog_.silence() >= watchdog_.limit() + options_.stallPatience) {
    lose(silenceText() + "; opens it anew");
  }
}

std::string CameraSupervisor::silenceText() const {
  const FrameCounts counts = frames_.counts();
  const std::uint64_t corrupt = counts.corrupt - framesBeforeSilence_.corrupt;
  const std::uint64_t incomplete = counts.incomplete - framesBeforeSilence_.incomplete;
  const std::uint64_t misTimed = counts.misTimed - framesBeforeSilence_.misTimed;
  const std::string duration = durationText(watchdog_.silence());
  if (corrupt + incomplete + misTimed == 0) return "has given no frame for " + duration;
  return "has given no usable frame for " + duration + " (" + std::to_string(corrupt) +
         " corrupt, " + std::to_string(incomplete) + " incomplete, " + std::to_string(misTimed) +
         " with a wrong time)";
}

void CameraSupervisor::lose(std::string reason, std::optional<Error> cause) {
  if (opened_) ++counts_.losses;
  if (state_ == CameraState::kStreaming || state_ == CameraState::kStalled) {
    backOff_.streamed(clock_.now() - streamingSince_);
  }
  enter(CameraState::kLost, std::move(reason), std::move(cause));
}

void CameraSupervisor::end(std::string reason, std::optional<Error> truncated) {
  truncated_ = std::move(truncated);
  enter(CameraState::kEnded, std::move(reason), truncated_);
}

void CameraSupervisor::closeAndBackOff() {
  close();
  const Duration wait = backOff_.grow();
  openAgainAt_ = clock_.now() + wait;
  enter(CameraState::kBackingOff, "opens again in " + durationText(wait));
}

void CameraSupervisor::backOff(TimePoint deadline) {
  clock_.sleepUntil(std::min(deadline, openAgainAt_), wakeToken());
  if (clock_.now() < openAgainAt_) return;
  haveDevicesChanged_ = false;  // the opening sees all changes until now
  camera_.reset();
  enter(CameraState::kOpening, "opens " + selector_.choice() + " again");
}

void CameraSupervisor::noteDeviceChange() {
  const bool isChangeOfInterest = state_ == CameraState::kStreaming ||
                                  state_ == CameraState::kStalled ||
                                  state_ == CameraState::kBackingOff;
  if (!isChangeOfInterest || !haveDevicesChanged_.exchange(false)) return;
  if (state_ != CameraState::kBackingOff) return;  // an open camera reports its own loss
  backOff_.reset();
  openAgainAt_ = std::min(openAgainAt_, clock_.now() + options_.settleTime);
}

void CameraSupervisor::wake() {
  const std::scoped_lock lock(mutex_);
  woken_.request_stop();
}

void CameraSupervisor::devicesChanged() {
  haveDevicesChanged_ = true;
  selector_.devicesChanged();
  wake();
}

void CameraSupervisor::stop() {
  isStopped_ = true;
  selector_.interrupt();
  wake();
}

bool CameraSupervisor::takeWake() {
  const std::scoped_lock lock(mutex_);
  if (!woken_.stop_requested()) return false;
  woken_ = std::stop_source();
  return true;
}

std::stop_token CameraSupervisor::wakeToken() const {
  const std::scoped_lock lock(mutex_);
  return woken_.get_token();
}

void CameraSupervisor::publishCounts() {
  counts_.frames = frames_.counts();
  const std::scoped_lock lock(mutex_);
  status_.counts = counts_;
}

SupervisorStatus CameraSupervisor::status() const {
  const std::scoped_lock lock(mutex_);
  return status_;
}

}  // namespace pleinair::hal
