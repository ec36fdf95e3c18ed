// Purpose: lists the strokes of alive anchors, in order, by the program that is to trace them
//          (stroke_lists.glsl). A single work group.
// Inputs:  anchors, slots of them; hasObjects and objectBounds (ArFrame), pixelsOfFull;
//          hasSegments; segment: the length of a step, px of the full image.
// Outputs: lists; strokes: those without an anchor are not seen.
// Precision: highp.
#include "pipeline/marks/shaders/anchor.glsl"
#include "pipeline/marks/shaders/stroke.glsl"
#include "pipeline/marks/shaders/stroke_lists.glsl"
#include "pipeline/marks/shaders/stroke_reach.glsl"
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

shared uint aliveBefore[128];
shared uint labelledBefore[128];

// Whether a stroke may meet labels of models or segments.
bool meetsLabels(uint slot) {
  bool isModel = isVirtual(objectOf(anchors[slot].surface));
  bool isNear = reachesObjects(anchors[slot].px, segment, objectBounds, pixelsOfFull);
  return hasSegments || (hasObjects && (isModel || isNear));
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
  uint alive = 0u;
  uint labelled = 0u;
  for (uint i = first; i < end; ++i) {
    bool isThere = isAlive(anchors[i].state);
    if (!isThere) strokes[i].seen = 0.0;
    alive += isThere ? 1u : 0u;
    labelled += isThere && meetsLabels(i) ? 1u : 0u;
  }
  aliveBefore[me] = alive;
  labelledBefore[me] = labelled;
  barrier();
  for (uint reach = 1u; reach < 128u; reach *= 2u) {
    uint aliveThere = me >= reach ? aliveBefore[me - reach] : 0u;
    uint labelledThere = me >= reach ? labelledBefore[me - reach] : 0u;
    barrier();
    aliveBefore[me] += aliveThere;
    labelledBefore[me] += labelledThere;
    barrier();
  }
  if (me == 127u) {
    writeLength(kWithLabels, labelledBefore[127]);
    writeLength(kMoversOnly, aliveBefore[127] - labelledBefore[127]);
  }
  uint nextLabelled = labelledBefore[me] - labelled;
  uint nextOther = aliveBefore[me] - alive - nextLabelled;
  for (uint i = first; i < end; ++i) {
    if (!isAlive(anchors[i].state)) continue;
    if (meetsLabels(i)) {
      lists[listedAt(kWithLabels, nextLabelled++, slots)] = i;
    } else {
      lists[listedAt(kMoversOnly, nextOther++, slots)] = i;
    }
  }
}
