#pragma once

#include "pipeline/tracking/camera/camera_model.h"

namespace pleinair::scene {

/// Whether the distortion may bend straight lines.
bool bendsLines(const tracking::Distortion& distortion);

/// The distance from the axis, on the plane z = 1, up to which a lens model can be trusted: its
/// radial part grows up to there. Beyond, a fitted polynomial may fold back and project points far
/// outside of the image into it. At most kMaxTrustedRadius.
double trustedLensRadius(const tracking::Distortion& distortion);

inline constexpr double kMaxTrustedRadius = 4.0;  ///< 76° off the axis

}  // namespace pleinair::scene
