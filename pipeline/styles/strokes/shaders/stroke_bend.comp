// Purpose: chooses the knots of the spline at which a stroke's strip bends: as few quads as its
//          curvature needs.
// Defines: LONG: stroke_strip.glsl's; it also bends at every other knot, counted
//          from both ends: it swells as its widths do. If widths chose knots, their noise would be seen.
// Inputs:  instances, instanceCount of them in drawn; bend: px that a quad's chord may deviate.
// Outputs: plans: breaks, and whether the stroke is carried. One invocation per stroke.
// Precision: highp.
#include "pipeline/marks/strokes/shaders/stroke_label.glsl"
#include "pipeline/styles/strokes/shaders/strip_spline.glsl"
layout(local_size_x = 64) in;
layout(std430, binding = 1) readonly buffer Drawn { DrawCommand drawn; };
layout(std430, binding = 2) writeonly buffer Plans { StripPlan plans[]; };
uniform float bend;

void main() {
  uint rank = gl_GlobalInvocationID.x;
  if (rank >= drawn.instanceCount) return;
  float halfWidth = instances[rank].shape.x;
  uint breaks = 0u;
  float way = 0.0;
  float turn = 0.0;
#ifdef LONG
  const uint kEvenly = 0xAB54u;
#endif
  // the first span, a sixth of a full span long, is straight
  SplinePlace before = splineAt(rank, 1.0);
  for (int knot = 2; knot < kSplineSpans; ++knot) {
    SplinePlace here = splineAt(rank, float(knot));
    float further = distance(here.at, before.at);
    float turned = distance(here.along, before.along);
    // An arc of length l that turns by θ deviates from its chord by l θ / 8; its sides, half a
    // width away, deviate by another half width × θ² / 8.
    float turns = turn + turned;
    bool isOff = (way + further + halfWidth * turns) * turns > 8.0 * bend;
#ifdef LONG
    if ((kEvenly >> uint(knot - 1) & 1u) != 0u) isOff = true;
#endif
    if (isOff && way > 0.0) breaks |= 1u << uint(knot - 1);
    way = isOff ? further : way + further;
    turn = isOff ? turned : turns;
    before = here;
  }
  if (goesByItself(uint(instances[rank].shape.z))) breaks |= kCarried;
  plans[rank].breaks = breaks;
}
