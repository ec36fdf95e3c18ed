// Purpose: the painting order of the visible strokes: accents after all others, and among each other
//          in an order that never changes during their lives and does not depend on their places. A
//          single work group.
// Inputs:  strokes, slots of them; stride: coprime to slots; vertices of each.
// Outputs: ranks: of each slot, or none; command: glDrawArraysIndirect's.
// Precision: integers.
#include "pipeline/gpu/shaders/draw_command.glsl"
#include "pipeline/marks/strokes/shaders/stroke.glsl"
layout(local_size_x = 128) in;
layout(std430, binding = 0) readonly buffer Strokes { Stroke strokes[]; };
layout(std430, binding = 1) writeonly buffer Ranks { uint ranks[]; };
layout(std430, binding = 2) volatile writeonly buffer Command { DrawCommand command; };
uniform uint slots;
uniform uint stride;
uniform uint vertices;

const float kMinSeen = 0.004;

shared uvec2 seenBefore[128];  // accents apart

uint slotAt(uint place) { return (place * stride) % slots; }

// 1 in X for a stroke, in Y for an accent; 0 for what is not seen.
uvec2 isSeen(uint slot) {
  if (strokes[slot].seen <= kMinSeen) return uvec2(0u);
  bool isAccent = (strokes[slot].state & kAccent) != 0u;
  return uvec2(isAccent ? 0u : 1u, isAccent ? 1u : 0u);
}

void main() {
  uint me = gl_LocalInvocationID.x;
  uint each = (slots + 127u) / 128u;
  uint first = min(me * each, slots);
  uint end = min(first + each, slots);
  uvec2 seen = uvec2(0u);
  for (uint i = first; i < end; ++i) seen += isSeen(slotAt(i));
  seenBefore[me] = seen;
  barrier();
  for (uint reach = 1u; reach < 128u; reach *= 2u) {
    uvec2 there = me >= reach ? seenBefore[me - reach] : uvec2(0u);
    barrier();
    seenBefore[me] += there;
    barrier();
  }
  uvec2 all = seenBefore[127];
  if (me == 127u) command = DrawCommand(vertices, all.x + all.y, 0u, 0u);
  uvec2 rank = seenBefore[me] - seen + uvec2(0u, all.x);
  for (uint i = first; i < end; ++i) {
    uint slot = slotAt(i);
    uvec2 one = isSeen(slot);
    ranks[slot] = one == uvec2(0u) ? 0xFFFFFFFFu : one.x * rank.x + one.y * rank.y;
    rank += one;
  }
}
