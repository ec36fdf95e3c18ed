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

template <class T>
bool LiveOverlay::Late<T>::isFor(const StepShown& shown) const {
  return !making.valid() && of && isSameStep(*of, shown);
}

template <class T>
bool LiveOverlay::Late<T>::isToBeMadeFor(const StepShown& shown) const {
  return !making.valid() && !(of && isSameStep(*of, shown));
}

template <class T>
void LiveOverlay::Late<T>::take() {
  if (isReady(making)) made = making.get();
}

LiveOverlay::~LiveOverlay() {
  movieEnds_.request_stop();
}

/// Takes what the threads have made. Returns whether that is another content.
bool LiveOverlay::takeMade() {
  const bool isMade = isReady(making_);
  if (isMade) content_ = making_.get();
  inset_.take();
  movie_.take();
  // An instruction comes first and alone, also where the rest is there already.
  if (isMade || making_.valid()) return isMade;
  const bool takesInset = !hasInset_ && inset_.isFor(last_);
  const bool takesMovie = !hasMovie_ && movie_.isFor(last_);
  if (takesInset) hasInset_ = true;
  if (takesMovie) hasMovie_ = true;
  if (!takesInset && !(takesMovie && movie_.made)) return false;
  auto whole = std::make_shared<overlay::OverlayContent>(*content_);
  if (takesInset) whole->inset = inset_.made;
  if (takesMovie) whole->movie = movie_.made;
  content_ = std::move(whole);
  return true;
}

/// Begins what the last step lacks.
void LiveOverlay::makeLate() {
  if (inset_.isToBeMadeFor(last_)) {
    inset_.of = last_;
    inset_.making = std::async(std::launch::async, [this, step = last_] { return draw(step); });
  }
  // One of a step that has passed is not decoded to its end.
  if (movie_.making.valid() && movie_.of && !isSameStep(*movie_.of, last_)) {
    movieEnds_.request_stop();
    movie_.of.reset();
  }
  // Its place is known once the instruction is made.
  if (making_.valid() || !movie_.isToBeMadeFor(last_)) return;
  movie_.of = last_;
  movie_.made = nullptr;
  if (content_->moviePlace.size.width == 0) return;
  movieEnds_ = std::stop_source();
  movie_.making = std::async(std::launch::async, [this, step = last_, place = content_->moviePlace,
                                                  stop = movieEnds_.get_token()] {
    return stepMovie(step, folder_, place, stop);
  });
}

std::shared_ptr<const overlay::OverlayContent> LiveOverlay::update(StepShown shown,
                                                                   hal::TimePoint now) {
  const std::string& failure = failure_.at(now);
  const std::string& notice = notice_.at(now);
  shown.notice = failure + (failure.empty() || notice.empty() ? "" : "\n") + notice;
  if (!content_) {
    last_ = std::move(shown);
    inset_.of = last_;
    inset_.made = draw(last_);
    hasInset_ = true;
    content_ = make(last_, inset_.made, nullptr);
    makeLate();
    return content_;
  }
  const bool isNew = takeMade();
  // A change that comes meanwhile waits: the newest state is made next, not those in between.
  if (!making_.valid() && !isSame(last_, shown)) {
    last_ = std::move(shown);
    hasInset_ = inset_.isFor(last_);
    hasMovie_ = movie_.isFor(last_);
    making_ = std::async(
        std::launch::async,
        [this, step = last_, inset = hasInset_ ? inset_.made : blankInset(output_.width),
         movie = hasMovie_ ? movie_.made : nullptr] { return make(step, inset, movie); });
  }
  makeLate();
  return isNew ? content_ : nullptr;
}

/// Any thread.
hal::Image LiveOverlay::draw(const StepShown& shown) const {
  return stepInset(shown, *shown.procedure->model, output_.width);
}

/// Any thread.
LiveOverlay::Content LiveOverlay::make(const StepShown& shown, hal::Image inset,
                                       Movie movie) const {
  const scene::Model& parts = *shown.procedure->model;
  overlay::OverlayContent content = stepContent(shown, parts, folder_, output_, std::move(inset));
  content.movie = std::move(movie);
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
