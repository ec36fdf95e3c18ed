#pragma once

#include <cstddef>
#include <cstdint>
#include <utility>
#include <variant>
#include <vector>

#include "hal/cameras/synthetic/synthetic_camera.h"
#include "hal/clock.h"
#include "hal/error.h"

namespace pleinair::bench {

/// Frames of the workbench from `first` on, in memory.
inline std::vector<hal::CapturedFrame> workbenchFilm(
    hal::FrameSize size, std::uint64_t frames,
    hal::SyntheticShot shot = hal::SyntheticShot::kWalkaround, std::uint64_t first = 0) {
  hal::SteppedClock clock;
  hal::SyntheticCamera camera({.size = size, .frameCount = first + frames, .shot = shot}, clock);
  hal::orThrow(camera.start({}));
  std::vector<hal::CapturedFrame> film;
  for (std::uint64_t i = 0; i < first + frames; ++i) {
    hal::NextFrame next = camera.next(hal::TimePoint::max());
    if (i >= first) film.push_back(std::get<hal::CapturedFrame>(std::move(next)));
  }
  camera.stop();
  return film;
}

/// The place of the n-th frame of a film that is shown forth and back, so that no frame is far from
/// the one before.
inline std::size_t forthAndBack(std::uint64_t number, std::uint64_t frames) {
  const std::uint64_t place = number % (2 * frames - 2);
  return place < frames ? place : 2 * frames - 2 - place;
}

}  // namespace pleinair::bench
