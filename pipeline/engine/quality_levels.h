#pragma once

#include <cstddef>
#include <span>
#include <string_view>

#include "hal/pixel_format.h"

namespace pleinair {

/// What is done at a level of quality; painter.h's qualityLevels() are their names.
struct QualityPlan {
  std::string_view name;
  std::string_view help;
  double side = 1.0;  ///< of the picture that is painted, against the full one's
};

/// All, best first.
std::span<const QualityPlan> qualityPlans();

/// The size at which a picture of `full` is painted at a level: even where that leaves a picture,
/// so that what is done for 2x2 pixels lies where it does at other levels.
hal::FrameSize sizeAt(hal::FrameSize full, const QualityPlan& plan);

}  // namespace pleinair
