#include "firmware_app/live/screens.h"

#include <algorithm>
#include <chrono>
#include <utility>

#include "pipeline/present/waiting_picture.h"

namespace pleinair::app {
namespace {

constexpr hal::Duration kFirstPatience = std::chrono::seconds(1);
constexpr hal::Duration kPollInterval = std::chrono::milliseconds(1);

}  // namespace

Screens::Screens(std::string choice, std::optional<hal::Image> last, const hal::Clock& clock)
    : choice_(std::move(choice)), last_(std::move(last)), clock_(clock) {}

std::vector<runtime::OutputStage*> Screens::stages() const {
  std::vector<runtime::OutputStage*> stages;
  for (const Screen& each : screens_) stages.push_back(each.stage);
  return stages;
}

void Screens::update(const LiveProgress& progress) {
  const hal::TimePoint now = clock_.now();
  state_.update(progress, now);
  for (Screen& each : screens_) {
    const runtime::OutputStage::Status status = each.stage->status();
    const Awaited awaited = state_.of(status.lastShown, now);
    if (awaited == Awaited::kNothing || status.isFailed) {
      if (std::exchange(each.shown, std::nullopt)) each.stage->cancelWaiting();
      continue;
    }
    const hal::OutputFormat format = each.stage->format();
    const Drawn wanted{.text = waitingText(awaited, progress.camera, choice_),
                       .format = format.frame,
                       .quarterTurns = format.quarterTurns,
                       .starts = status.starts};
    // A frame that was painted late may have taken the picture's place.
    const bool isReplaced = !status.isWaitingShown && !status.isWaitingDue;
    if (each.shown != wanted || isReplaced) draw(each, wanted, awaited != Awaited::kPace);
  }
}

void Screens::draw(Screen& screen, const Drawn& wanted, bool fades) const {
  screen.shown = wanted;
  hal::FrameSize upright = wanted.format.size;
  if (wanted.quarterTurns % 2 != 0) std::swap(upright.width, upright.height);
  const std::optional<hal::Image> frame = uprightFrameOf(*screen.stage);
  const hal::ImageView painting = frame ? frame->view() : last_ ? last_->view() : hal::ImageView();
  const hal::Image picture = present::waitingPicture(upright, painting, wanted.text);
  screen.stage->showWaiting(
      std::make_shared<const hal::Image>(present::turned(picture, wanted.quarterTurns)), fades);
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
    clock.sleepUntil(clock.now() + kPollInterval);
  }
}

std::optional<hal::Image> Screens::lastPainting() const {
  for (const Screen& each : screens_) {
    if (auto frame = uprightFrameOf(*each.stage)) return frame;
  }
  return std::nullopt;
}

std::optional<hal::Image> Screens::uprightFrameOf(const runtime::OutputStage& stage) {
  const std::optional<hal::Image> frame = stage.lastFrame();
  if (!frame) return std::nullopt;
  return present::turned(*frame, -stage.format().quarterTurns);
}

}  // namespace pleinair::app
