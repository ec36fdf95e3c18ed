// Purpose: a stroke's strip of quads, as planned by stroke_bend.comp and stroke_offsets.comp.
// Defines: LONG: of long strokes (long_instance.glsl), whose width is given at each point.
// Inputs, outputs: px of the full image.
// Precision: highp.
#include "pipeline/gpu/shaders/draw_command.glsl"
#include "pipeline/marks/strokes/shaders/spline.glsl"
#ifdef LONG
#include "pipeline/styles/strokes/shaders/long_instance.glsl"
#else
#include "pipeline/marks/strokes/shaders/stroke_instance.glsl"
#endif

// The knots at which a stroke's strip is divided into quads, and its first vertex.
struct StripPlan {
  uint breaks;  // bit i: at the spline's i-th knot; kCarried
  uint first;
};
const uint kCarried = 1u << 31u;  // the stroke lies on a model or a mover

uint breaksOf(StripPlan plan) { return plan.breaks & ~kCarried; }
bool isCarried(StripPlan plan) { return (plan.breaks & kCarried) != 0u; }

// Each strip's first and last vertex are doubled, which joins all strips into one.
uint stripVertices(uint quads) { return 2u * quads + 4u; }
