#pragma once

#include <cstddef>

#include <glm/vec3.hpp>

#include "hal/pixel_format.h"
#include "pipeline/marks/fidelity_field.h"
#include "pipeline/scene/render/ar_frame.h"
#include "pipeline/styles/hatching/hatch_lines.h"
#include "pipeline/styles/hatching/hatching_parameters.h"

namespace pleinair::styles {

/// What the parameters, given for images of 640×480, come to in an image of another size.

constexpr std::size_t kMaxHatchSets = 3;  ///< directions

/// A change of it makes new lines.
struct DrawingPlan {
  std::size_t sets = 0;
  HatchPlan lines;
  bool operator==(const DrawingPlan&) const = default;
};

DrawingPlan drawingPlanOf(const HatchingParameters& p, hal::FrameSize full);

/// How the lines of a set, counted from 0, are drawn in a frame.
HatchRule hatchRuleOf(const HatchingParameters& p, const scene::ArFrame& frame, std::size_t set);

/// Where contours show more than elsewhere.
marks::FidelityField fidelityOf(const HatchingParameters& p, const scene::ArFrame& frame);

/// The factor on lengths, by the size of the full image.
double hatchScale(hal::FrameSize full);

/// RGB in [0, 1].
glm::vec3 inkColourOf(const HatchingParameters& p);

}  // namespace pleinair::styles
