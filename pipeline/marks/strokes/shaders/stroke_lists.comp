// Purpose: lists the strokes of alive anchors, in order, by the program that is to trace them
//          (stroke_lists.glsl). A single work group.
// Inputs:  anchors, slots of them; hasObjects and objectBounds (ArFrame), pixelsOfFull;
//          hasSegments; segment: the length of a step, px of the full image.
// Outputs: lists; strokes: those without an anchor are not seen.
// Precision: highp.
#include "pipeline/marks/anchors/shaders/anchor.glsl"
#include "pipeline/marks/strokes/shaders/stroke.glsl"
#include "pipeline/marks/strokes/shaders/stroke_lists.glsl"
#include "pipeline/marks/strokes/shaders/stroke_reach.glsl"
#include "pipeline/scene/render/shaders/object_id.glsl"
layout(local_size_x = 128) in;
layout(std430, binding = 0) readonly buffer Anchors { Anchor anchors[]; };
layout(std430, binding = 1) buffer Strokes { Stroke strokes[]; };
layout(std430, binding = 2) writeonly buffer StrokeLists { uint lists[]; };
uniform uint slots;
uniform float segment;
uniform vec4 objectBounds;
uniform vec2 pixelsOfFull;
uniform bool hasObjects;
uniform bool hasSegments;

shared uvec3 before[128];  // strokes of each list, in the order of the lists

// The list of a stroke. Movers' know nothing of labels: what the camera sees goes on behind models.
int listOf(uint slot) {
  if (hasObjects && isVirtual(objectOf(anchors[slot].surface))) return kOnModels;
  if ((anchors[slot].state & kMover) != 0u) return kMoversOnly;
  bool isNear = reachesObjects(anchors[slot].px, segment, objectBounds, pixelsOfFull);
  return hasSegments || (hasObjects && isNear) ? kWithLabels : kMoversOnly;
}

uvec3 isList(int list) {
  return uvec3(list == kOnModels, list == kWithLabels, list == kMoversOnly);
}

void writeLength(int list, uint length) {
  lists[list] = (length + kTraceGroup - 1u) / kTraceGroup;
  lists[list + 3] = length;
}

void main() {
  uint me = gl_LocalInvocationID.x;
  uint each = (slots + 127u) / 128u;
  uint first = min(me * each, slots);
  uint end = min(first + each, slots);
  uvec3 mine = uvec3(0u);
  for (uint i = first; i < end; ++i) {
    bool isThere = isAlive(anchors[i].state);
    if (!isThere) strokes[i].seen = 0.0;
    if (isThere) mine += isList(listOf(i));
  }
  before[me] = mine;
  barrier();
  for (uint reach = 1u; reach < 128u; reach *= 2u) {
    uvec3 there = me >= reach ? before[me - reach] : uvec3(0u);
    barrier();
    before[me] += there;
    barrier();
  }
  uvec3 all = before[127];
  if (me == 127u) {
    writeLength(kOnModels, all.x);
    writeLength(kWithLabels, all.y);
    writeLength(kMoversOnly, all.z);
  }
  uvec3 next = before[me] - mine;
  for (uint i = first; i < end; ++i) {
    if (!isAlive(anchors[i].state)) continue;
    int list = listOf(i);
    uvec3 one = isList(list);
    lists[listedAt(list, next.x * one.x + next.y * one.y + next.z * one.z, all.x, slots)] = i;
    next += one;
  }
}
