#include "firmware_app/live/interaction/display_captions.h"

#include <utility>

#include "pipeline/present/caption_picture.h"
#include "pipeline/present/waiting_picture.h"

namespace pleinair::app {

std::shared_ptr<const runtime::Caption> captionFor(const std::string& text,
                                                   const hal::OutputFormat& format) {
  hal::FrameSize upright = format.frame.size;
  const int turns = (format.quarterTurns % 4 + 4) % 4;
  if (turns % 2 != 0) std::swap(upright.width, upright.height);
  const present::CaptionPicture picture = present::captionPicture(text, upright);
  const hal::FrameSize size = picture.image.size();
  if (size.width == 0) return nullptr;
  const int right = upright.width - picture.left - size.width;
  const int bottom = upright.height - picture.top - size.height;
  auto caption = std::make_shared<runtime::Caption>();
  caption->image = present::turned(picture.image, turns);
  caption->frame = format.frame;
  // Turned clockwise, what was below lies on the left.
  caption->left = turns == 0   ? picture.left
                  : turns == 1 ? bottom
                  : turns == 2 ? right
                               : picture.top;
  caption->top = turns == 0 ? picture.top : turns == 1 ? picture.left : turns == 2 ? bottom : right;
  return caption;
}

void DisplayCaptions::update(const std::vector<runtime::OutputStage*>& displays,
                             const LiveCaption& caption) {
  const bool isSeen = caption.shown(0.0).opacity > 0.0;
  if (!isSeen && drawn_.empty()) return;
  for (runtime::OutputStage* each : displays) {
    if (!isSeen) {
      each->setCaption(nullptr, 0.0);
      continue;
    }
    const LiveCaption::Shown now = caption.shown(each->status().perSecond);
    const hal::OutputFormat format = each->format();
    Drawn& drawn = drawn_[each];
    if (drawn.text != now.text || drawn.format != format.frame ||
        drawn.quarterTurns != format.quarterTurns) {
      drawn = {.text = now.text,
               .format = format.frame,
               .quarterTurns = format.quarterTurns,
               .caption = captionFor(now.text, format)};
    }
    each->setCaption(drawn.caption, now.opacity);
  }
  if (!isSeen) drawn_.clear();
}

}  // namespace pleinair::app
