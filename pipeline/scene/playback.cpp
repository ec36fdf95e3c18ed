#include "pipeline/scene/playback.h"

#include <algorithm>
#include <chrono>
#include <cmath>

namespace pleinair::scene {

std::optional<ClipMoment> momentOf(const Rig& rig, const Playback& playback,
                                   hal::Duration elapsed) {
  if (!playback.clip) return std::nullopt;
  const double length = rig.clips[*playback.clip].seconds;
  const double run = playback.speed * std::chrono::duration<double>(elapsed).count();
  ClipMoment moment{.clip = *playback.clip};
  if (playback.loops) {
    if (length > 0.0) {
      moment.seconds = std::clamp(run - length * std::floor(run / length), 0.0, length);
    }
  } else {
    moment.seconds = std::clamp(playback.speed < 0.0 ? length + run : run, 0.0, length);
  }
  return moment;
}

}  // namespace pleinair::scene
