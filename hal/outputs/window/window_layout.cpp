#include "hal/outputs/window/window_layout.h"

#include <algorithm>
#include <cassert>
#include <cstdint>

namespace pleinair::hal::window {
namespace {

/// length × numerator / denominator, rounded, at least 1.
int scaled(int length, int numerator, int denominator) {
  const std::int64_t product = std::int64_t{length} * numerator;
  return std::max(1, static_cast<int>((product + denominator / 2) / denominator));
}

FrameSize fitted(FrameSize picture, FrameSize room) {
  const bool isWider =
      std::int64_t{picture.width} * room.height > std::int64_t{picture.height} * room.width;
  if (isWider) return {room.width, scaled(picture.height, room.width, picture.width)};
  return {scaled(picture.width, room.height, picture.height), room.height};
}

}  // namespace

Area letterBox(FrameSize picture, FrameSize window) {
  assert(picture.width > 0 && picture.height > 0 && window.width > 0 && window.height > 0);
  const FrameSize size = fitted(picture, window);
  return {
      .x = (window.width - size.width) / 2, .y = (window.height - size.height) / 2, .size = size};
}

Area turnedLetterBox(FrameSize picture, FrameSize window, int quarterTurns) {
  if (quarterTurns % 2 == 0) return letterBox(picture, window);
  const Area seen = letterBox({picture.height, picture.width}, window);
  const FrameSize size{seen.size.height, seen.size.width};
  return {.x = seen.x + (seen.size.width - size.width) / 2,
          .y = seen.y + (seen.size.height - size.height) / 2,
          .size = size};
}

FrameSize openingSize(FrameSize picture, FrameSize room) {
  constexpr int kMinSide = 240;  // less is hard to find on a screen
  const int times = std::max(1, kMinSide / std::max(picture.width, picture.height));
  const FrameSize wanted{picture.width * times, picture.height * times};
  const bool fits = wanted.width <= room.width && wanted.height <= room.height;
  return fits ? wanted : fitted(picture, room);
}

}  // namespace pleinair::hal::window
