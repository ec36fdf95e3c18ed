// How an output stage hands frames to its output, and learns what became of them.
#include <algorithm>
#include <cassert>
#include <cstdint>
#include <optional>
#include <utility>

#include "pipeline/runtime/output/output_stage.h"

namespace pleinair::runtime {

hal::Result<hal::Fence> copyImage(const hal::ImageView& image, hal::SurfaceOutput& output,
                                  const hal::Surface& surface) {
  const hal::Result<hal::SurfaceMapping> mapping = output.map(surface);
  if (!mapping) return tl::unexpected(mapping.error());
  const auto copied = hal::copyToSurface(image, surface, *mapping);
  if (!copied) return tl::unexpected(copied.error());
  return hal::Fence();
}

hal::Result<hal::Fence> copyOutputFrame(const OutputFrame& frame, hal::SurfaceOutput& output,
                                        const hal::Surface& surface) {
  return copyImage(frame.image.view(), output, surface);
}

/// Capture time since the first frame that this opening of the output has got.
hal::Duration OutputStage::timeOf(const WaitingFrame& frame) {
  if (!firstTime_) firstTime_ = frame.captured;
  return frame.captured - *firstTime_;
}

void OutputStage::present(const Due& due) {
  fadeIn(due);
  if (hal::SurfaceOutput* surfaces = output_->surfaces()) {
    presentSurface(*surfaces, due);
  } else {
    presentInMemory(*output_->memory(), due);
  }
}

/// Precondition: the mutex is held.
void OutputStage::countShown(const WaitingFrame& frame, hal::TimePoint time) {
  reopenAfter_ = kFirstReopenDelay;
  ++status_.presented;
  status_.isWaitingShown = false;
  waitingSeen_.reset();
  rate_.count(time);
  latency_.add(time - frame.captured, time);
}

/// Hands over the picture, or the surface that it was drawn into. False if that is lent no more.
hal::Answer OutputStage::writeFrame(hal::MemoryOutput& output, const Due& due) {
  OutputFrame& frame = *buffers_.at(due.frame.buffer);
  const hal::Duration time = timeOf(due.frame);
  const auto drawn = std::exchange(frame.surface, std::nullopt);
  isDirect_ = drawn.has_value();
  if (isDirect_ && !lending_.isCurrent(*drawn)) return false;
  hal::Result<void> written =
      isDirect_ ? output.show(drawn->id, time) : output.write(frame.image.view(), time);
  if (!written) return tl::unexpected(std::move(written.error()));
  const std::scoped_lock lock(mutex_);
  directOnScreen_.reset();
  if (!isDirect_) return true;
  lending_.countDirect();
  directOnScreen_ = drawn->id;
  ++directShown_;
  return true;
}

void OutputStage::presentInMemory(hal::MemoryOutput& output, const Due& due) {
  const hal::TimePoint began = clock_.now();
  const std::uint64_t skippedBefore = output.skippedPictures();
  const hal::Answer written = writeFrame(output, due);
  const bool isSkipped = output.skippedPictures() > skippedBefore;
  const hal::TimePoint ended = clock_.now();
  const std::scoped_lock lock(mutex_);
  isWriting_ = false;
  queue_.presented(ended);
  writing_.add(ended - began, ended);
  if (written.hasError()) {
    end(due.frame, Outcome::kOutputFailed);
    fail(written.error());
    return;
  }
  if (!written.isYes()) {
    end(due.frame, Outcome::kNoSurface);
    return;
  }
  if (isSkipped) {
    reopenAfter_ = kFirstReopenDelay;
    ++status_.skipped;
    end(due.frame, Outcome::kOutputBusy);
    return;
  }
  countShown(due.frame, began);
  retire(due.frame);
  count(due.frame, due.outcome, {.shown = began});
}

void OutputStage::presentSurface(hal::SurfaceOutput& output, const Due& due) {
  const hal::TimePoint began = clock_.now();
  const hal::Answer submitted = submitSurface(output, due);
  const hal::TimePoint ended = clock_.now();
  const std::scoped_lock lock(mutex_);
  isWriting_ = false;
  queue_.presented(ended);
  writing_.add(ended - began, ended);
  if (submitted.hasError()) {
    end(due.frame, Outcome::kOutputFailed);
    fail(submitted.error());
  } else if (!submitted.isYes()) {
    end(due.frame, outcomeWithoutSurface());
  } else {
    retire(due.frame);
    noteFilling(ended - began);
  }
}

/// Hands later frames over so early that surfaces are filled when a display wants them: half a
/// refresh before the due one. Not two refreshes before, when the surface that it replaces may
/// still be in use. Precondition: the mutex is held.
void OutputStage::noteFilling(hal::Duration took) {
  if (!refresh_) return;
  fillTime_ = std::max(took, fillTime_ - fillTime_ / 16);
  const hal::Duration half = refresh_->period / 2;
  queue_.setLead(half + std::clamp(fillTime_ + fillTime_ / 4, half, half * 5 / 2));
}

/// The surface that has the frame: the one that it was drawn into, else one that it is copied to;
/// nothing if none is free.
hal::Result<std::optional<hal::Surface>> OutputStage::fillSurface(hal::SurfaceOutput& output,
                                                                  OutputFrame& frame,
                                                                  hal::Fence& fence) {
  isDirect_ = frame.surface.has_value();
  if (const auto drawn = std::exchange(frame.surface, std::nullopt)) {
    if (!lending_.isCurrent(*drawn)) return std::nullopt;
    lending_.countDirect();
    hal::Surface surface;
    surface.id = drawn->id;
    return surface;
  }
  hal::Result<std::optional<hal::Surface>> surface = output.acquire();
  if (!surface || !*surface) return surface;
  const std::shared_ptr<const Caption> caption = drawCaption(frame.image);
  const bool isDimmed = swapDimmed(frame.image);
  hal::Result<hal::Fence> filled = options_.fill(frame, output, **surface);
  if (isDimmed) std::swap(frame.image, dimmed_);
  if (caption) captions_.remove(frame.image, *caption);
  if (!filled) {
    output.release(**surface);
    return tl::unexpected(filled.error());
  }
  fence = *std::move(filled);
  return surface;
}

/// Puts a darker copy in the frame's place, and the frame into dimmed_, where the display is
/// dimmed; else returns false.
bool OutputStage::swapDimmed(hal::Image& frame) {
  Brightness brightness = kFullBrightness;
  {
    const std::scoped_lock lock(mutex_);
    brightness = brightness_;
  }
  if (brightness == kFullBrightness || frame.format().pixelFormat != hal::PixelFormat::kRgba8) {
    return false;
  }
  if (dimmed_.format() != frame.format()) dimmed_ = hal::Image(frame.format());
  dim(frame.view(), brightness, dimmed_);
  std::swap(frame, dimmed_);
  return true;
}

/// False if no surface is free.
hal::Answer OutputStage::submitSurface(hal::SurfaceOutput& output, const Due& due) {
  hal::Fence fence;
  const auto filled = fillSurface(output, *buffers_.at(due.frame.buffer), fence);
  if (!filled) return tl::unexpected(filled.error());
  if (!*filled) return false;
  const hal::Surface& surface = **filled;
  // A frame shown early, to avoid a freeze, is submitted for immediate display.
  const hal::TimePoint time =
      due.outcome == Outcome::kShown ? due.frame.due : std::min(due.frame.due, clock_.now());
  const auto submitted = output.submit(surface, std::move(fence), time);
  if (!submitted) return tl::unexpected(submitted.error());
  const std::scoped_lock lock(mutex_);
  // Told by the newest flip, which is at most some refreshes ago.
  const auto dueRefresh =
      refresh_ ? hal::sequenceAt(due.frame.due, *refresh_) : std::optional<std::uint64_t>();
  queued_.push_back(
      {.surface = surface.id, .frame = due.frame, .dueRefresh = dueRefresh, .isDirect = isDirect_});
  return true;
}

void OutputStage::takeEvents() {
  hal::SurfaceOutput* const surfaces = output_ ? output_->surfaces() : nullptr;
  if (surfaces == nullptr) return;
  bool isSomebodyThere = false;
  {
    const std::scoped_lock lock(mutex_);
    if (status_.isFailed) return;
    isSomebodyThere = std::exchange(isSomebodyThere_, false);
  }
  if (isSomebodyThere) surfaces->noteActivity();
  events_.clear();
  // Also where nothing is queued, because a display comes and goes without pictures.
  hal::Result<void> taken = surfaces->takeEvents(events_);
  const std::scoped_lock lock(mutex_);
  followSuspension(*surfaces);
  followBrightness(*surfaces);
  for (const hal::PresentationEvent& event : events_) ended(event);
  if (!taken) fail(std::move(taken.error()));
}

/// Precondition: the mutex is held.
void OutputStage::followSuspension(const hal::SurfaceOutput& output) {
  const hal::Suspension* const now = output.suspension();
  if (now == nullptr) {
    status_.suspension.reset();
    return;
  }
  directOnScreen_.reset();  // what it shows afterwards may be black
  if (!status_.suspension || *status_.suspension != *now) {
    status_.suspension = *now;
  }
}

/// Frames bring another brightness along by themselves. Precondition: the mutex is held.
void OutputStage::followBrightness(const hal::SurfaceOutput& output) {
  status_.brightness = output.brightness();
  const Brightness now = brightnessOf(status_.brightness);
  if (std::exchange(brightness_, now) != now) showWaitingAgain();
}

/// Precondition: the mutex is held.
Outcome OutputStage::outcomeWithoutSurface() const {
  const hal::Suspension* const suspension = output_->surfaces()->suspension();
  if (suspension == nullptr) return Outcome::kNoSurface;
  return suspension->cause == hal::Suspension::Cause::kBlank ? Outcome::kBlanked
                                                             : Outcome::kSuspended;
}

/// Precondition: the mutex is held.
void OutputStage::ended(const hal::PresentationEvent& event) {
  const bool isShown = event.result == hal::PresentationEvent::Result::kShown;
  if (isShown && refresh_) {
    refresh_->phase = event.time;
    refresh_->sequence = event.sequence;
  }
  if (waitingSurface_ == event.surface) {
    waitingSurface_.reset();
    if (isShown) {
      directOnScreen_.reset();
      ++status_.waitingShown;
    } else {
      status_.isWaitingShown = false;
    }
    return;
  }
  const auto queued = std::ranges::find(queued_, event.surface, &Queued::surface);
  assert(queued != queued_.end());
  const Outcome outcome = outcomeOf(event, *queued);
  if (isShown) {
    countShown(queued->frame, event.time);
    directOnScreen_.reset();
    if (queued->isDirect) directOnScreen_ = event.surface;
    if (queued->isDirect) ++directShown_;
  }
  count(queued->frame, outcome,
        {.dueRefresh = queued->dueRefresh,
         .shown = isShown ? std::optional(event.time) : std::nullopt,
         .refresh = event.sequence});
  queued_.erase(queued);
}

Outcome OutputStage::outcomeOf(const hal::PresentationEvent& event, const Queued& queued) const {
  using Result = hal::PresentationEvent::Result;
  if (event.result == Result::kSuperseded) return Outcome::kSuperseded;
  if (event.result == Result::kSkipped) {
    const Outcome outcome = outcomeWithoutSurface();
    return outcome == Outcome::kNoSurface ? Outcome::kOutputBusy : outcome;
  }
  return isOnTime(event, queued) ? Outcome::kShown : Outcome::kShownOffSchedule;
}

/// By the display's count where it has one: the times that drivers give may be off, and a clock
/// cannot tell a refresh from the next as well as the display can.
bool OutputStage::isOnTime(const hal::PresentationEvent& event, const Queued& queued) const {
  if (event.sequence && queued.dueRefresh) return *event.sequence == *queued.dueRefresh;
  // Any refresh but the due one is at least one period away.
  const hal::Duration off = event.time - queued.frame.due;
  const hal::Duration tolerance = refresh_ ? refresh_->period / 2 : options_.rules.tolerance;
  return off > -tolerance && off < tolerance;
}

}  // namespace pleinair::runtime
