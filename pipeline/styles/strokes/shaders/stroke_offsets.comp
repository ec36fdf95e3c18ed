// Purpose: the first vertex of each stroke's strip, in painting order. A single work group.
// Inputs:  instanceCount strokes in drawn; plans: breaks; even: if above 0, the number of quads of
//          every strip; clips: whether strokes are clipped; byMovers: if so, by movers alone;
//          busyWord: then the word of busyWords (marks/busy_blocks.h) that tells whether there are any.
// Outputs: plans: first; commands: glDrawArraysIndirect's of what is not clipped and of what is:
//          all strokes are the one or the other. A stroke that a mover has carried may outlive it: while
//          there is one, strokes are clipped.
// Precision: integers.
#include "pipeline/styles/strokes/shaders/stroke_strip.glsl"
layout(local_size_x = 128) in;
layout(std430, binding = 0) readonly buffer Drawn { DrawCommand drawn; };
layout(std430, binding = 1) buffer Plans { StripPlan plans[]; };
layout(std430, binding = 2) volatile writeonly buffer Commands { DrawCommand commands[2]; };
layout(std430, binding = 3) readonly buffer BusyBlocks { uint busyWords[]; };
uniform uint even;
uniform bool clips;
uniform bool byMovers;
uniform uint busyWord;

shared uint before[128];
shared uint carried;

uint verticesOf(uint rank) {
  return stripVertices(even > 0u ? even : 1u + uint(bitCount(breaksOf(plans[rank]))));
}

void main() {
  uint me = gl_LocalInvocationID.x;
  uint strokes = drawn.instanceCount;
  uint each = (strokes + 127u) / 128u;
  uint start = min(me * each, strokes);
  uint end = min(start + each, strokes);
  uint mine = 0u;
  uint flags = 0u;
  if (me == 0u) carried = 0u;
  for (uint i = start; i < end; ++i) {
    mine += verticesOf(i);
    flags |= plans[i].breaks;
  }
  before[me] = mine;
  barrier();
  if ((flags & kCarried) != 0u) atomicOr(carried, 1u);
  for (uint reach = 1u; reach < 128u; reach *= 2u) {
    uint there = me >= reach ? before[me - reach] : 0u;
    barrier();
    before[me] += there;
    barrier();
  }
  if (me == 127u) {
    bool isClipped = clips && !(byMovers && carried == 0u && busyWords[busyWord] == 0u);
    commands[0] = DrawCommand(isClipped ? 0u : before[127], 1u, 0u, 0u);
    commands[1] = DrawCommand(isClipped ? before[127] : 0u, 1u, 0u, 0u);
  }
  uint place = before[me] - mine;
  for (uint i = start; i < end; ++i) {
    plans[i].first = place;
    place += verticesOf(i);
  }
}
