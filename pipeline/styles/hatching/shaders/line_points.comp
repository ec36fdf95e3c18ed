// Purpose: what each line lies on, and anchors as points for their neighbours to find
//          (marks/anchors/point_bins.h).
// Inputs:  anchors, slots of them; line_support.glsl's; anew: lines have no past.
// Outputs: lines: label; points, whose penalty is here that label, and kJustBorn of new ones. One
//          invocation per anchor.
// Precision: integers.
#include "pipeline/marks/anchors/shaders/point.glsl"
#include "pipeline/styles/hatching/shaders/line.glsl"
#include "pipeline/styles/hatching/shaders/line_shift.glsl"
#include "pipeline/styles/hatching/shaders/line_support.glsl"
layout(local_size_x = 64) in;
layout(std430, binding = 0) readonly buffer Anchors { Anchor anchors[]; };
// volatile: docs/gpu.md, rule 22
layout(std430, binding = 1) volatile writeonly buffer Points { ivec4 points[]; };
layout(std430, binding = 2) buffer Lines { Line lines[]; };
uniform uint slots;
uniform bool anew;

void main() {
  uint slot = gl_GlobalInvocationID.x;
  if (slot >= slots) return;
  uint state = anchors[slot].state;
  bool isNew = anew || (state & kBorn) != 0u;
  vec2 px = anchors[slot].px;
  uint label = supportOf(px, anchors[slot].surface, state, isNew ? 0u : lines[slot].label);
  lines[slot].label = label;
  ivec4 point = pointAt(px, 0.0, int(slot));
  point.z = int(label | ((state & kBorn) != 0u ? kJustBorn : 0u));
  if (!isAlive(state)) point = kNoPoint;
  points[slot].xy = point.xy;
  points[slot].zw = point.zw;
}
