// Purpose: anchors as points for their neighbours to find (marks/point_bins.h).
// Inputs:  anchors, slots of them.
// Outputs: points, whose penalty is here what they lie on, and kJustBorn of new ones. One
//          invocation per anchor.
// Precision: integers.
#include "pipeline/marks/shaders/anchor.glsl"
#include "pipeline/marks/shaders/point.glsl"
#include "pipeline/styles/hatching/shaders/line_support.glsl"
layout(local_size_x = 64) in;
layout(std430, binding = 0) readonly buffer Anchors { Anchor anchors[]; };
layout(std430, binding = 1) writeonly buffer Points { ivec4 points[]; };
uniform uint slots;

void main() {
  uint slot = gl_GlobalInvocationID.x;
  if (slot >= slots) return;
  uint state = anchors[slot].state;
  ivec4 point = pointAt(anchors[slot].px, 0.0, int(slot));
  point.z = int(supportOf(anchors[slot].surface, state) | ((state & kBorn) != 0u ? kJustBorn : 0u));
  points[slot] = isAlive(state) ? point : kNoPoint;
}
