#pragma once

#include <array>
#include <cstdint>

#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

#include "hal/cameras/synthetic/render/shot.h"
#include "hal/cameras/synthetic/world/bodies.h"

namespace pleinair::hal::synthetic {

/// A smooth, seeded signal around 0: a sum of a few sinusoids with unrelated periods and phases.
class SmoothNoise {
 public:
  SmoothNoise() = default;
  /// Varies within ±`amplitude`; its slowest component has a period of about `periodSeconds`.
  SmoothNoise(std::uint64_t seed, double amplitude, double periodSeconds);
  double at(double seconds) const;

 private:
  struct Wave {
    double amplitude = 0;
    double radiansPerSecond = 0;
    double phaseRadians = 0;
  };
  std::array<Wave, 3> waves_;
};

/// The motion of the camera and of the bodies in a shot: pure functions of the time since the first
/// frame, smooth except at the cuts of kCut. World frame: z up from the bench's top, y away from
/// the person at the bench, metres.
class Motion {
 public:
  Motion(SyntheticShot shot, std::uint64_t seed);

  /// Maps world coordinates to OpenCV's camera frame (x right, y down, z forward); rigid.
  glm::dmat4 cameraFromWorld(double seconds) const;
  /// Where the bodies of the shot are: the room, and the arm of kOccluder and kHand or the figures
  /// of kVisitors, kCrossing and kPortrait.
  BodyPoses bodies(double seconds) const;

 private:
  glm::dmat4 walkaround(double seconds) const;
  glm::dmat4 heldAt(glm::dvec3 eye, glm::dvec3 target, double seconds) const;
  glm::dmat4 cut(double seconds) const;

  SyntheticShot shot_;
  SmoothNoise targetX_, targetY_, distance_;  // metres
  SmoothNoise slant_, azimuth_, roll_;        // radians
  std::array<SmoothNoise, 3> handShift_;      // metres
  std::array<SmoothNoise, 3> handTurn_;       // radians
};

}  // namespace pleinair::hal::synthetic
