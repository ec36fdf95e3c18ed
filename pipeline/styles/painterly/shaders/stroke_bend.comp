// Purpose: as few quads as a stroke's curvature needs: where along its spline a strip is to bend.
// Inputs:  instances, instanceCount of them in drawn; bend: px that a quad's chord may lie off.
// Outputs: plans: breaks. A stroke an invocation.
// Precision: highp.
#include "pipeline/marks/shaders/spline.glsl"
#include "pipeline/styles/painterly/shaders/stroke_instance.glsl"
layout(local_size_x = 64) in;
layout(std430, binding = 0) readonly buffer Instances { Instance instances[]; };
layout(std430, binding = 1) readonly buffer Drawn { DrawCommand drawn; };
layout(std430, binding = 2) writeonly buffer Plans { StripPlan plans[]; };
uniform float bend;

void main() {
  uint rank = gl_GlobalInvocationID.x;
  if (rank >= drawn.instanceCount) return;
  vec2 points[8];
  pointsOf(instances[rank].points, points);
  float halfWidth = instances[rank].shape.x;
  uint breaks = 0u;
  float way = 0.0;
  float turn = 0.0;
  SplinePlace before = splineAt(points, 1.0);  // the first span, a sixth of a part long, is straight
  for (int knot = 2; knot < kSplineSpans; ++knot) {
    SplinePlace here = splineAt(points, float(knot));
    float further = distance(here.at, before.at);
    float turned = distance(here.along, before.along);
    // An arc that turns by θ over a length l lies l θ / 8 off its chord, and its sides, which are
    // half a width away, that times θ² / 8 more.
    float turns = turn + turned;
    bool isOff = (way + further + halfWidth * turns) * turns > 8.0 * bend;
    if (isOff && way > 0.0) breaks |= 1u << uint(knot - 1);
    way = isOff ? further : way + further;
    turn = isOff ? turned : turns;
    before = here;
  }
  plans[rank].breaks = breaks;
}
