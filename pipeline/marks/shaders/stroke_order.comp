// Purpose: the painting order of the visible strokes. It never changes during their lives and does
//          not depend on their places. A single work group.
// Inputs:  strokes, slots of them; stride: coprime to slots; vertices of each.
// Outputs: ranks: of each slot, or none; command: glDrawArraysIndirect's.
// Precision: integers.
#include "pipeline/gpu/shaders/draw_command.glsl"
#include "pipeline/marks/shaders/stroke.glsl"
layout(local_size_x = 128) in;
layout(std430, binding = 0) readonly buffer Strokes { Stroke strokes[]; };
layout(std430, binding = 1) writeonly buffer Ranks { uint ranks[]; };
layout(std430, binding = 2) volatile writeonly buffer Command { DrawCommand command; };
uniform uint slots;
uniform uint stride;
uniform uint vertices;

const float kMinSeen = 0.004;

shared uint seenBefore[128];

uint slotAt(uint place) { return (place * stride) % slots; }

void main() {
  uint me = gl_LocalInvocationID.x;
  uint each = (slots + 127u) / 128u;
  uint first = min(me * each, slots);
  uint end = min(first + each, slots);
  uint seen = 0u;
  for (uint i = first; i < end; ++i) seen += strokes[slotAt(i)].seen > kMinSeen ? 1u : 0u;
  seenBefore[me] = seen;
  barrier();
  for (uint reach = 1u; reach < 128u; reach *= 2u) {
    uint there = me >= reach ? seenBefore[me - reach] : 0u;
    barrier();
    seenBefore[me] += there;
    barrier();
  }
  if (me == 127u) command = DrawCommand(vertices, seenBefore[127], 0u, 0u);
  uint rank = seenBefore[me] - seen;
  for (uint i = first; i < end; ++i) {
    uint slot = slotAt(i);
    bool isSeen = strokes[slot].seen > kMinSeen;
    ranks[slot] = isSeen ? rank : 0xFFFFFFFFu;
    rank += isSeen ? 1u : 0u;
  }
}
