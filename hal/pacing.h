#pragma once

namespace pleinair::hal {

/// When a recorded or simulated camera hands out its frames.
enum class Pacing {
  kStepped,   ///< every frame at once: offline rendering
  kRealTime,  ///< each frame at its capture time by the clock
};

}  // namespace pleinair::hal
