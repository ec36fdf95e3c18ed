#pragma once

#include "pipeline/marks/anchor_set.h"
#include "pipeline/marks/motion_field.h"
#include "pipeline/marks/stroke_set.h"
#include "pipeline/marks/tensor_field.h"
#include "pipeline/styles/painterly/painterly_parameters.h"

namespace pleinair::styles {

// How the painter holds on to its past: what the dial `coherence` scales, and its parts, each of
// which can be switched off to see what it is worth: `warp`, `history`, `hysteresis`, `fades`.

/// What time constants are scaled by: 0 at 0 (at once), 1 in the middle (the thesis's), for ever
/// at 1.
double holdOf(const PainterlyParameters& p);

marks::MotionFieldOptions motionOf(const PainterlyParameters& p);
marks::TensorFieldOptions fieldOf(const PainterlyParameters& p);
marks::AnchorHold anchorHoldOf(const PainterlyParameters& p);
/// Says it of strokes.
void holdOn(marks::StrokeRule& rule, const PainterlyParameters& p);

}  // namespace pleinair::styles
