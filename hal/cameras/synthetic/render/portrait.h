#pragma once

#include <glm/vec3.hpp>

#include "hal/cameras/synthetic/world/bodies.h"

namespace pleinair::hal::synthetic {

/// Where the camera of the shot kPortrait stands, and what it looks at: a bare wall.
inline constexpr glm::dvec3 kPortraitEye{0.90, -2.20, 0.56};
inline constexpr glm::dvec3 kPortraitTarget{2.70, -2.20, 0.47};
/// The shot starts over after this time.
inline constexpr double kPortraitSeconds = 12;

/// Places the parts of the first figure at `seconds` of the shot kPortrait: it comes from the left
/// within 2.2 s, stands close to the camera, sways, turns its head and nods, raises a hand now and
/// then, and leaves from 9.3 s on.
void placePortrait(double seconds, BodyPoses& bodies);

}  // namespace pleinair::hal::synthetic
