#include "firmware_app/live/screens/screens.h"

#include <algorithm>
#include <chrono>
#include <memory>
#include <utility>

#include "pipeline/present/waiting_picture.h"

namespace pleinair::app {
namespace {

constexpr hal::Duration kFirstPatience = std::chrono::seconds(1);
constexpr hal::Duration kFirstPollInterval = std::chrono::milliseconds(1);

}  // namespace

Screens::Screens(std::string choice, const std::filesystem::path& state, const hal::Clock& clock)
    : choice_(std::move(choice)), store_(state), clock_(clock) {}

void Screens::add(runtime::OutputStage& stage, bool keepsPainting, bool isStepped) {
  if (keepsPainting && std::ranges::none_of(screens_, &Screen::keepsPainting)) {
    hal::Result<std::optional<hal::Image>> kept = store_.read();
    if (kept) {
      last_ = *std::move(kept);
    } else {
      failure_ = std::move(kept.error());
    }
  }
  screens_.push_back(
      {.stage = &stage, .keepsPainting = keepsPainting, .isStepped = isStepped, .shown = {}});
}

std::vector<runtime::OutputStage*> Screens::stages() const {
  std::vector<runtime::OutputStage*> stages;
  for (const Screen& each : screens_) stages.push_back(each.stage);
  return stages;
}

void Screens::update(const LiveProgress& progress) {
  const hal::TimePoint now = clock_.now();
  state_.update(progress, now);
  const Awaited awaited = state_.awaited(now);
  for (Screen& each : screens_) {
    const runtime::OutputStage::Status status = each.stage->status();
    if (awaited == Awaited::kNothing || status.isFailed) {
      if (std::exchange(each.shown, std::nullopt)) each.stage->cancelWaiting();
      each.picture.reset();
      continue;
    }
    const hal::OutputFormat format = each.stage->format();
    const Drawn wanted{.text = waitingText(awaited, progress.camera, choice_),
                       .format = format.frame,
                       .quarterTurns = format.quarterTurns,
                       .isMirrored = format.isMirrored,
                       .starts = status.starts};
    // A frame that was painted late may have taken the picture's place.
    const bool isReplaced = !status.isWaitingShown && !status.isWaitingDue;
    const bool isNew = each.shown != wanted || isReplaced;
    const bool isStale = renewal_ > hal::Duration{0} && now - each.handedOver >= renewal_;
    if (isNew) draw(each, wanted);
    if (isNew || isStale) show(each, awaited != Awaited::kPace);
  }
  if (auto failure = store_.takeFailure()) failure_ = std::move(failure);
  if (progress.hasBegun && store_.isDue(now)) keep(now);
}

/// A display that is off shows none: the same one is not written again.
void Screens::keep(hal::TimePoint now) {
  const std::uint64_t shown = paintingsShown();
  if (shown == kept_) return;
  if (auto painting = lastPainting()) {
    kept_ = shown;
    store_.save(*std::move(painting), now);
  }
}

std::uint64_t Screens::paintingsShown() const {
  std::uint64_t shown = 0;
  for (const Screen& each : screens_) {
    if (each.keepsPainting) shown += each.stage->status().presented;
  }
  return shown;
}

void Screens::finish() {
  const hal::TimePoint now = clock_.now();
  if (store_.isDueAtEnd(now)) keep(now);
  if (auto failure = store_.takeFailure(true)) failure_ = std::move(failure);
}

void Screens::draw(Screen& screen, const Drawn& wanted) {
  screen.shown = wanted;
  hal::FrameSize upright = wanted.format.size;
  if (wanted.quarterTurns % 2 != 0) std::swap(upright.width, upright.height);
  if (screen.isStepped) screen.stage->refreshLastFrame();
  const std::optional<hal::Image> frame = uprightFrameOf(*screen.stage);
  const bool hasLast = last_ && screen.keepsPainting;
  const hal::ImageView painting = frame     ? frame->view()
                                  : hasLast ? last_->view()
                                            : hal::ImageView();
  constexpr std::uint64_t kNone = 0;
  constexpr std::uint64_t kOfTheRunBefore = 1;
  const std::uint64_t number = frame     ? kOfTheRunBefore + ++frames_
                               : hasLast ? kOfTheRunBefore
                                         : kNone;
  const hal::Image picture = pictures_.draw(upright, painting, number, wanted.text);
  const hal::Image shown = present::turned(picture, wanted.quarterTurns);
  screen.picture =
      std::make_shared<const hal::Image>(wanted.isMirrored ? present::mirrored(shown) : shown);
}

void Screens::show(Screen& screen, bool fades) const {
  screen.handedOver = clock_.now();
  screen.stage->showWaiting(screen.picture, fades);
}

void Screens::showFirst(hal::Clock& clock) {
  const hal::TimePoint deadline = clock.now() + kFirstPatience;
  const auto isDone = [](const Screen& screen) {
    const runtime::OutputStage::Status status = screen.stage->status();
    return status.isFailed || (status.isWaitingShown && screen.stage->isIdle());
  };
  for (;;) {
    for (Screen& each : screens_) each.stage->step();
    if (std::ranges::all_of(screens_, isDone) || clock.now() >= deadline) return;
    clock.sleepUntil(clock.now() + kFirstPollInterval);
  }
}

/// The last frame of the first screen that has shown one, upright.
std::optional<hal::Image> Screens::lastPainting() const {
  for (const Screen& each : screens_) {
    if (!each.keepsPainting) continue;
    if (auto frame = uprightFrameOf(*each.stage)) return frame;
  }
  return std::nullopt;
}

std::optional<hal::Image> Screens::uprightFrameOf(const runtime::OutputStage& stage) {
  const std::optional<hal::Image> frame = stage.lastFrame();
  if (!frame) return std::nullopt;
  const hal::OutputFormat format = stage.format();
  const hal::Image upright = present::turned(*frame, -format.quarterTurns);
  return format.isMirrored ? present::mirrored(upright) : upright;
}

}  // namespace pleinair::app
