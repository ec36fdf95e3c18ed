// Purpose: the first vertex of each stroke's strip, in painting order, carried strokes after all
//          others: they are drawn by another program. A single work group.
// Inputs:  instanceCount strokes in drawn; plans: breaks; room: vertices that there is room for, eight
//          for each stroke at least; even: if above 0, the number of quads of every strip; clips:
//          whether strokes are clipped; byMovers: if so, by movers alone; busyWord: then the word of
//          busyWords (marks/movers/busy_blocks.h) that tells whether there are any.
// Outputs: plans: first, and fewer breaks of all strokes where there is not room for all vertices;
//          commands: glDrawArraysIndirect's of what is not clipped and of what is: all strokes but
//          carried ones are the one or the other; and of carried ones. A stroke that a mover has
//          carried may outlive it: while there is one, strokes are clipped.
// Precision: integers.
#include "pipeline/styles/strokes/shaders/stroke_strip.glsl"
layout(local_size_x = 128) in;
layout(std430, binding = 0) readonly buffer Drawn { DrawCommand drawn; };
layout(std430, binding = 1) buffer Plans { StripPlan plans[]; };
layout(std430, binding = 2) volatile writeonly buffer Commands { DrawCommand commands[3]; };
layout(std430, binding = 3) readonly buffer BusyBlocks { uint busyWords[]; };
uniform uint room;
uniform uint even;
uniform bool clips;
uniform bool byMovers;
uniform uint busyWord;

const int kThinnings = 2;  // they leave one of six breaks

shared uvec2 before[128];  // vertices: of carried strokes in y

// Keeps every second break, or the only one.
uint thinned(uint breaks) {
  uint kept = bitCount(breaks) == 1 ? breaks : 0u;
  while (breaks != 0u) {
    breaks &= breaks - 1u;
    kept |= breaks & (~breaks + 1u);
    breaks &= breaks - 1u;
  }
  return kept;
}

uvec2 verticesOf(uint rank) {
  uint count = stripVertices(even > 0u ? even : 1u + uint(bitCount(breaksOf(plans[rank]))));
  return isCarried(plans[rank]) ? uvec2(0u, count) : uvec2(count, 0u);
}

void main() {
  uint me = gl_LocalInvocationID.x;
  uint strokes = drawn.instanceCount;
  uint each = (strokes + 127u) / 128u;
  uint start = min(me * each, strokes);
  uint end = min(start + each, strokes);
  uvec2 mine;
  uvec2 all;
  for (int thinnings = 0; thinnings <= kThinnings; ++thinnings) {
    mine = uvec2(0u);
    for (uint i = start; i < end; ++i) {
      if (thinnings > 0) {
        plans[i].breaks = (plans[i].breaks & kCarried) | thinned(breaksOf(plans[i]));
      }
      mine += verticesOf(i);
    }
    barrier();
    before[me] = mine;
    barrier();
    for (uint reach = 1u; reach < 128u; reach *= 2u) {
      uvec2 there = me >= reach ? before[me - reach] : uvec2(0u);
      barrier();
      before[me] += there;
      barrier();
    }
    all = before[127];
    if (even > 0u || all.x + all.y <= room) break;
  }
  if (me == 127u) {
    bool isClipped = clips && !(byMovers && all.y == 0u && busyWords[busyWord] == 0u);
    commands[0] = DrawCommand(isClipped ? 0u : all.x, 1u, 0u, 0u);
    commands[1] = DrawCommand(isClipped ? all.x : 0u, 1u, 0u, 0u);
    commands[2] = DrawCommand(all.y, 1u, all.x, 0u);
  }
  uvec2 place = before[me] - mine + uvec2(0u, all.x);
  for (uint i = start; i < end; ++i) {
    plans[i].first = isCarried(plans[i]) ? place.y : place.x;
    place += verticesOf(i);
  }
}
