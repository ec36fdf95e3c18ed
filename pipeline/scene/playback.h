#pragma once

#include <cstddef>
#include <optional>

#include "hal/clock.h"
#include "pipeline/scene/rig.h"

namespace pleinair::scene {

/// How a model's clip is played in a scene.
struct Playback {
  std::optional<std::size_t> clip;  ///< of Rig::clips; nothing: it stands at rest
  double speed = 1.0;               ///< 2: twice as fast; negative: backwards
  bool loops = true;                ///< else it stays as it ends
  /// Time starts when what it is attached to is first seen; else with the first frame.
  bool startsOnSight = false;
};

/// A moment of a clip.
struct ClipMoment {
  std::size_t clip = 0;
  double seconds = 0.0;  ///< 0 … Clip::seconds
};

/// Where `playback` is `elapsed` after its start (≥ 0); nothing where it plays none.
std::optional<ClipMoment> momentOf(const Rig& rig, const Playback& playback, hal::Duration elapsed);

}  // namespace pleinair::scene
