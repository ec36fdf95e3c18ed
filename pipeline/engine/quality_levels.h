#pragma once

#include <cstddef>
#include <span>
#include <string_view>

#include "hal/pixel_format.h"

namespace pleinair {

/// How a quality level is painted. qualityLevels() in painter.h gives the names.
struct QualityPlan {
  std::string_view name;
  std::string_view help;
  double side = 1.0;  ///< side of the painted picture divided by that of the full one
};

/// All levels, best first.
std::span<const QualityPlan> qualityPlans();

/// The size at which a picture of size `full` is painted at a level. Both sides are even, unless
/// that would leave nothing, so that blocks of 2x2 px lie at the same places at all levels.
hal::FrameSize sizeAt(hal::FrameSize full, const QualityPlan& plan);

}  // namespace pleinair
