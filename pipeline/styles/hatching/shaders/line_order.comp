// Purpose: the place of each visible line among those that are drawn, in the order of slots, so
//          that pictures are repeatable. A single work group.
// Inputs:  lines, slots of them.
// Outputs: ranks: the place of each slot, or none; command: their number.
// Precision: integers.
#include "pipeline/gpu/shaders/draw_command.glsl"
#include "pipeline/styles/hatching/shaders/line.glsl"
layout(local_size_x = 128) in;
layout(std430, binding = 0) readonly buffer Lines { Line lines[]; };
layout(std430, binding = 1) writeonly buffer Ranks { uint ranks[]; };
layout(std430, binding = 2) volatile writeonly buffer Command { DrawCommand command; };
uniform uint slots;

const float kMinSeen = 0.01;

shared uint seenBefore[128];

void main() {
  uint me = gl_LocalInvocationID.x;
  uint each = (slots + 127u) / 128u;
  uint first = min(me * each, slots);
  uint end = min(first + each, slots);
  uint seen = 0u;
  for (uint i = first; i < end; ++i) seen += lines[i].seen > kMinSeen ? 1u : 0u;
  seenBefore[me] = seen;
  barrier();
  for (uint reach = 1u; reach < 128u; reach *= 2u) {
    uint there = me >= reach ? seenBefore[me - reach] : 0u;
    barrier();
    seenBefore[me] += there;
    barrier();
  }
  if (me == 127u) command = DrawCommand(0u, seenBefore[127], 0u, 0u);
  uint place = seenBefore[me] - seen;
  for (uint i = first; i < end; ++i) {
    bool isSeen = lines[i].seen > kMinSeen;
    ranks[i] = isSeen ? place : 0xFFFFFFFFu;
    place += isSeen ? 1u : 0u;
  }
}
