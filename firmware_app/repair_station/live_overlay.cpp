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

std::shared_ptr<const overlay::OverlayContent> LiveOverlay::update(StepShown shown,
                                                                   hal::TimePoint now) {
  const std::string& failure = failure_.at(now);
  const std::string& notice = notice_.at(now);
  shown.notice = failure + (failure.empty() || notice.empty() ? "" : "\n") + notice;
  Content made;
  if (making_.valid() && making_.wait_for(std::chrono::seconds(0)) == std::future_status::ready) {
    made = content_ = making_.get();
  }
  // A change that comes meanwhile waits: the newest state is made next, not those in between.
  if (making_.valid() || (last_ && isSame(*last_, shown))) return made;
  const bool keepsInset = last_ && content_ && isSameStep(*last_, shown);
  last_ = std::move(shown);
  if (!content_) return content_ = make(*last_, nullptr);
  making_ = std::async(std::launch::async,
                       [this, step = *last_, before = keepsInset ? content_ : nullptr] {
                         return make(step, before);
                       });
  return made;
}

/// Any thread. `before`: the same step's, whose inset is kept; null: another step's.
LiveOverlay::Content LiveOverlay::make(const StepShown& shown, const Content& before) const {
  const scene::Model& parts = *shown.procedure->model;
  overlay::OverlayContent content =
      stepContent(shown, parts, folder_, output_, before ? &before->inset : nullptr);
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
