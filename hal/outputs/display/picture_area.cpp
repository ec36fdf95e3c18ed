#include "hal/outputs/display/picture_area.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace pleinair::hal::display {

PictureArea areaOf(FrameSize picture, FrameSize display, const Placement& placement) {
  const auto inset = [&](int side) {
    return static_cast<int>(std::lround(side * placement.marginPercent / 100.0));
  };
  const FrameSize room{std::max(1, display.width - 2 * inset(display.width)),
                       std::max(1, display.height - 2 * inset(display.height))};
  FrameSize size = room;
  if (placement.fit == Placement::Fit::kLetterbox) {
    if (placement.quarterTurns % 2 != 0) std::swap(picture.width, picture.height);
    const double scale = std::min(static_cast<double>(room.width) / picture.width,
                                  static_cast<double>(room.height) / picture.height);
    size = {std::clamp(static_cast<int>(std::lround(picture.width * scale)), 1, room.width),
            std::clamp(static_cast<int>(std::lround(picture.height * scale)), 1, room.height)};
  }
  return {
      .x = (display.width - size.width) / 2, .y = (display.height - size.height) / 2, .size = size};
}

}  // namespace pleinair::hal::display
