#pragma once

#include "hal/cameras/synthetic/render/shot.h"

namespace pleinair::hal::synthetic {

/// The shot kLights starts over after this time.
inline constexpr double kLightsSeconds = 8;

/// Whether the spotlight is on: in kLights from 1 s to 2.5 s, otherwise never.
bool isSpotlightOn(SyntheticShot shot, double seconds);

/// The factor of the picture's linear light, as an automatic exposure changes it: in kLights it
/// falls from 1 to 0.75 between 4 s and 6 s and is back at 1 at 8 s, otherwise it is 1.
double exposureGain(SyntheticShot shot, double seconds);

}  // namespace pleinair::hal::synthetic
