#include "firmware_app/repair_station/live_overlay.h"

#include <algorithm>
#include <chrono>
#include <utility>

namespace pleinair::app {
namespace {

constexpr hal::Duration kNoticeFor = std::chrono::seconds(5);

/// Whether looks, ghosts and inset are the same.
bool isSameStep(const StepShown& a, const StepShown& b) {
  return a.procedure == b.procedure && a.step == b.step && a.partsOff == b.partsOff;
}

bool isSame(const StepShown& a, const StepShown& b) {
  return isSameStep(a, b) && a.request == b.request && a.notice == b.notice && a.isDone == b.isDone;
}

/// An edited procedure may have another model than the one that is painted.
bool hasSameParts(const scene::Model& a, const scene::Model& b) {
  return std::ranges::equal(a.parts, b.parts, {}, &scene::ModelPart::name, &scene::ModelPart::name);
}

template <class T>
bool isReady(const std::future<T>& made) {
  return made.valid() && made.wait_for(std::chrono::seconds(0)) == std::future_status::ready;
}

}  // namespace

LiveOverlay::LiveOverlay(const scene::Model* machine, std::filesystem::path folder,
                         hal::FrameSize output, bool showsInset, std::vector<int> cards)
    : machine_(machine),
      folder_(std::move(folder)),
      output_(output),
      showsInset_(showsInset),
      cards_(std::move(cards)) {}

void LiveOverlay::notify(const std::string& text, hal::TimePoint now) {
  notice_ = {.text = text, .ends = now + kNoticeFor};
}

void LiveOverlay::notifyFailure(const std::string& text, hal::TimePoint now) {
  const std::string before = failure_.at(now);
  const bool isNew = before.find(text) == std::string::npos;
  failure_ = {.text = before + (before.empty() || !isNew ? "" : "\n") + (isNew ? text : ""),
              .ends = now + kNoticeFor};
}

const std::string& LiveOverlay::Passing::at(hal::TimePoint now) {
  if (now >= ends) text.clear();
  return text;
}

/// Whether the inset of the step was drawn.
bool LiveOverlay::isDrawn(const StepShown& shown) const {
  return !drawing_.valid() && drawn_ && isSameStep(*drawn_, shown);
}

/// Takes what the threads have made. Returns whether that is another content.
bool LiveOverlay::takeMade() {
  const bool isMade = isReady(making_);
  if (isMade) content_ = making_.get();
  if (isReady(drawing_)) inset_ = drawing_.get();
  if (hasInset_ || making_.valid() || !isDrawn(last_)) return isMade;
  auto whole = std::make_shared<overlay::OverlayContent>(*content_);
  whole->inset = inset_;
  content_ = std::move(whole);
  return hasInset_ = true;
}

std::shared_ptr<const overlay::OverlayContent> LiveOverlay::update(StepShown shown,
                                                                   hal::TimePoint now) {
  const std::string& failure = failure_.at(now);
  const std::string& notice = notice_.at(now);
  shown.notice = failure + (failure.empty() || notice.empty() ? "" : "\n") + notice;
  if (!content_) {
    last_ = std::move(shown);
    drawn_ = last_;
    inset_ = draw(last_);
    hasInset_ = true;
    return content_ = make(last_, inset_);
  }
  const bool isNew = takeMade();
  // A change that comes meanwhile waits: the newest state is made next, not those in between.
  if (!making_.valid() && !isSame(last_, shown)) {
    last_ = std::move(shown);
    hasInset_ = isDrawn(last_);
    making_ =
        std::async(std::launch::async,
                   [this, step = last_, inset = hasInset_ ? inset_ : blankInset(output_.width)] {
                     return make(step, inset);
                   });
  }
  if (!drawing_.valid() && !isSameStep(*drawn_, last_)) {
    drawn_ = last_;
    drawing_ = std::async(std::launch::async, [this, step = last_] { return draw(step); });
  }
  return isNew ? content_ : nullptr;
}

/// Any thread.
hal::Image LiveOverlay::draw(const StepShown& shown) const {
  return stepInset(shown, *shown.procedure->model, output_.width);
}

/// Any thread.
LiveOverlay::Content LiveOverlay::make(const StepShown& shown, hal::Image inset) const {
  const scene::Model& parts = *shown.procedure->model;
  overlay::OverlayContent content = stepContent(shown, parts, folder_, output_, std::move(inset));
  content.showsInset = showsInset_;
  content.cards = cards_;
  if (machine_ != nullptr && !hasSameParts(*machine_, parts)) {
    content.looks.clear();
    content.ghosts.clear();
    content.arrows.clear();
    content.labels.clear();
    content.showsInset = true;
  }
  return std::make_shared<const overlay::OverlayContent>(std::move(content));
}

}  // namespace pleinair::app
