// Purpose: the first vertex of each stroke's strip, in painting order. A single work group.
// Inputs:  instanceCount strokes in drawn; plans: breaks; even: if above 0, the number of quads of
//          every strip.
// Outputs: plans: first; command: glDrawArraysIndirect's.
// Precision: integers.
#include "pipeline/styles/strokes/shaders/stroke_strip.glsl"
layout(local_size_x = 128) in;
layout(std430, binding = 0) readonly buffer Drawn { DrawCommand drawn; };
layout(std430, binding = 1) buffer Plans { StripPlan plans[]; };
layout(std430, binding = 2) volatile writeonly buffer Command { DrawCommand command; };
uniform uint even;

shared uint before[128];

uint verticesOf(uint rank) {
  return stripVertices(even > 0u ? even : 1u + uint(bitCount(plans[rank].breaks)));
}

void main() {
  uint me = gl_LocalInvocationID.x;
  uint strokes = drawn.instanceCount;
  uint each = (strokes + 127u) / 128u;
  uint start = min(me * each, strokes);
  uint end = min(start + each, strokes);
  uint mine = 0u;
  for (uint i = start; i < end; ++i) mine += verticesOf(i);
  before[me] = mine;
  barrier();
  for (uint reach = 1u; reach < 128u; reach *= 2u) {
    uint there = me >= reach ? before[me - reach] : 0u;
    barrier();
    before[me] += there;
    barrier();
  }
  if (me == 127u) command = DrawCommand(before[127], 1u, 0u, 0u);
  uint place = before[me] - mine;
  for (uint i = start; i < end; ++i) {
    plans[i].first = place;
    place += verticesOf(i);
  }
}
