#include "firmware_app/live/interaction/live_caption.h"

#include <fmt/format.h>

namespace pleinair::app {

void LiveCaption::keyPressed() {
  notice_.clear();
  fading_.restart(clock_.now());
}

void LiveCaption::notify(const std::string& notice) {
  notice_ = notice;
  fading_.restart(clock_.now());
}

std::string LiveCaption::fadingText(double framesPerSecond) const {
  const std::string first = notice_.empty() ? tuning_.parameterLine() : notice_;
  const std::string text =
      fmt::format("{}\n{} · {:.0f} frames/s", first, tuning_.state(), framesPerSecond);
  return tuning_.showsHelp() ? tuning_.help() + "\n\n" + text : text;
}

LiveCaption::Shown LiveCaption::shown(double framesPerSecond) const {
  const double fading = fading_.opacity(clock_.now());
  const bool isHeld = tuning_.showsHelp() || !pinned_.empty();
  Shown shown{.text = {}, .opacity = isHeld ? 1.0 : fading};
  if (shown.opacity > 0.0) shown.text = fadingText(framesPerSecond);
  if (pinned_.empty()) return shown;
  const bool isAlone = fading == 0.0 && !tuning_.showsHelp();
  shown.text = isAlone ? pinned_ : pinned_ + "\n\n" + shown.text;
  return shown;
}

}  // namespace pleinair::app
