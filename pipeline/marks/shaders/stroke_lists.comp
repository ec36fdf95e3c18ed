// Purpose: lists the strokes of alive anchors by the program that is to trace them
//          (stroke_lists.glsl). The order of a list is left to chance: each stroke is traced by
//          itself, in its slot, and reads no other one.
// Inputs:  anchors, slots of them; hasObjects and objectBounds (ArFrame), pixelsOfFull;
//          hasSegments; segment: the length of a step, px of the full image.
// Outputs: lists, which stroke_order.comp has emptied; strokes: those without an anchor are not
//          seen. One invocation per slot.
// Precision: highp.
#include "pipeline/marks/shaders/anchor.glsl"
#include "pipeline/marks/shaders/stroke.glsl"
#include "pipeline/marks/shaders/stroke_lists.glsl"
#include "pipeline/marks/shaders/stroke_reach.glsl"
#include "pipeline/scene/render/shaders/object_id.glsl"
layout(local_size_x = 64) in;
layout(std430, binding = 0) readonly buffer Anchors { Anchor anchors[]; };
layout(std430, binding = 1) buffer Strokes { Stroke strokes[]; };
layout(std430, binding = 2) coherent buffer StrokeLists { uint lists[]; };
uniform uint slots;
uniform float segment;
uniform vec4 objectBounds;
uniform vec2 pixelsOfFull;
uniform bool hasObjects;
uniform bool hasSegments;

void main() {
  uint slot = gl_GlobalInvocationID.x;
  if (slot >= slots) return;
  if (!isAlive(anchors[slot].state)) {
    strokes[slot].seen = 0.0;
    return;
  }
  bool isModel = hasObjects && isVirtual(objectOf(anchors[slot].surface));
  bool isNear =
      hasObjects && reachesObjects(anchors[slot].px, segment, objectBounds, pixelsOfFull);
  bool knowsAll = hasSegments || isModel || isNear;
  int list = knowsAll ? kWithLabels : kMoversOnly;
  uint number = atomicAdd(lists[list + 3], 1u);
  atomicMax(lists[list], number / kTraceGroup + 1u);
  lists[listedAt(list, number, slots)] = slot;
}
