#pragma once

#include "pipeline/tracking/camera/camera_model.h"

namespace pleinair::scene {

/// Whether straight lines may come out curved.
bool bendsLines(const tracking::Distortion& distortion);

/// How far from the axis, on the plane z = 1, a lens model can be trusted: up to there its radial
/// part grows with the distance. Beyond, a fitted polynomial may fold back and throw points that
/// are far outside the picture into it. At most kWidestLens.
double trustedLensRadius(const tracking::Distortion& distortion);

inline constexpr double kWidestLens = 4.0;  ///< 76° off the axis

}  // namespace pleinair::scene
