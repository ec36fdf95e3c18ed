#pragma once

#include "pipeline/marks/anchors/anchor_set.h"
#include "pipeline/marks/motion_field.h"
#include "pipeline/marks/strokes/stroke_set.h"
#include "pipeline/marks/tensors/tensor_field.h"
#include "pipeline/styles/painterly/painterly_parameters.h"

namespace pleinair::styles {

// How the style keeps its past: the constants that `coherence` scales, and the parts that can each
// be switched off, to measure their effect: `warp`, `history`, `hysteresis`, `fades`.

/// The factor of all time constants: 0 at 0 (at once), 1 in the middle (the thesis's), for ever
/// at 1.
double holdOf(const PainterlyParameters& p);

marks::MotionFieldOptions motionOf(const PainterlyParameters& p);
marks::TensorFieldOptions fieldOf(const PainterlyParameters& p);
marks::AnchorHold anchorHoldOf(const PainterlyParameters& p);
/// Applies the time constants to a layer's rule. `noiseLevels`: the camera's, in 1/255.
void holdOn(marks::StrokeRule& rule, const PainterlyParameters& p, double noiseLevels);
/// Whether movers are told from the background. At full coherence, strokes never let go.
bool tellsMovers(const PainterlyParameters& p);

}  // namespace pleinair::styles
