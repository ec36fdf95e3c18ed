#pragma once

#include <array>
#include <cstdint>

#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

#include "hal/clock.h"

namespace pleinair::hal::synthetic {

/// A smooth, seeded signal around 0: a few sinusoids with unrelated periods and phases.
class Wander {
 public:
  /// Swings within ±`amplitude`, its slowest part with about `period`.
  Wander(std::uint64_t seed, double amplitude, Duration period);
  double at(Duration time) const;

 private:
  struct Wave {
    double amplitude = 0;
    double radiansPerSecond = 0;
    double phaseRadians = 0;
  };
  std::array<Wave, 3> waves_;
};

/// How a person holds a camera over a desk: it circles around, leans in and out, and trembles.
/// A pure function of time. The view slants 24° to 48° from the vertical at 0.66 to 0.94 m.
class HandheldPath {
 public:
  explicit HandheldPath(std::uint64_t seed);

  /// Rigid transform from the world (z up from the desk, metres) to OpenCV's camera frame
  /// (x right, y down, z forward), at `time` since the first frame.
  glm::dmat4 cameraFromWorld(Duration time) const;

 private:
  Wander targetX_, targetY_;           // metres
  Wander distance_;                    // metres
  Wander slant_, azimuth_, roll_;      // radians
  std::array<Wander, 3> trembleBy_;    // metres
  std::array<Wander, 3> trembleTurn_;  // radians
};

}  // namespace pleinair::hal::synthetic
