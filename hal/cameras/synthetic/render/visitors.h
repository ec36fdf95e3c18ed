#pragma once

#include "hal/cameras/synthetic/world/bodies.h"

namespace pleinair::hal::synthetic {

/// The shots kVisitors and kCrossing start over after these times.
inline constexpr double kVisitorsSeconds = 16;
inline constexpr double kCrossingSeconds = 8;

/// Places the figures' parts at `seconds` of the shot kVisitors: one figure crosses the room from
/// the left, a while later the other one from the right, which stops in the middle, looks at the
/// camera and walks on. When nobody crosses, both are beyond the image's sides.
void placeVisitors(double seconds, BodyPoses& bodies);

/// The same of the shot kCrossing: the figures come from both sides at once and pass each other in
/// the middle, the second one nearer to the camera, without stopping.
void placeCrossing(double seconds, BodyPoses& bodies);

}  // namespace pleinair::hal::synthetic
