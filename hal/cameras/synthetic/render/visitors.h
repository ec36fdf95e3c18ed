#pragma once

#include "hal/cameras/synthetic/world/bodies.h"

namespace pleinair::hal::synthetic {

/// The shot kVisitors starts over after this time.
inline constexpr double kVisitorsSeconds = 16;

/// Places the figures' parts at `seconds` of the shot kVisitors: one figure crosses the room from
/// the left, a while later the other one from the right, which stops in the middle, looks at the
/// camera and walks on. When nobody crosses, both are beyond the image's sides.
void placeVisitors(double seconds, BodyPoses& bodies);

}  // namespace pleinair::hal::synthetic
