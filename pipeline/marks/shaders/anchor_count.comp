// Purpose: fades anchors in and out, and counts the staying ones in each cell.
// Inputs:  anchor_cells.glsl's; ids and forms (ArFrame) and their pixelsOfFull if hasObjects;
//          fadeIn, fadeOut: the part of a fade that this frame completes.
// Outputs: anchors; cells, whose counts were 0 (anchor_spawn.comp). One invocation per anchor.
// Precision: highp; counts are integers, so that order does not matter.
#include "pipeline/marks/shaders/anchor.glsl"
#include "pipeline/marks/shaders/anchor_cells.glsl"
#include "pipeline/scene/render/shaders/object_id.glsl"
layout(local_size_x = 64) in;
layout(std430, binding = 0) buffer Anchors { Anchor anchors[]; };
layout(std430, binding = 1) buffer Cells { Cell cells[]; };
uniform float fadeIn;
uniform float fadeOut;
uniform uint slots;
uniform highp usampler2D ids;
uniform highp usampler2D forms;
uniform bool hasObjects;
uniform vec2 pixelsOfFull;
uniform vec2 fullSize;
#include "pipeline/scene/render/shaders/surface_form.glsl"

// The bit of the patch that an anchor's pixel shows, if it shows its object.
uint patchBitAt(vec2 px, uint object) {
  ivec2 pixel = clamp(ivec2(floor(px * pixelsOfFull)), ivec2(0), textureSize(forms, 0) - 1);
  if (!hasObjects || objectOf(texelFetch(ids, pixel, 0).r) != object) return 0u;
  return patchBit(labelOf(texelFetch(forms, pixel, 0).r));
}

const uint kSlotBits = 20u;
const float kAgeUnits = 64.0;  // units per second

void main() {
  uint slot = gl_GlobalInvocationID.x;
  if (slot >= slots) return;
  uint state = anchors[slot].state;
  if (!isAlive(state)) return;
  bool isBehind = isCovered(state);
  bool stays = isBehind || isStaying(state);
  if (!isBehind) {
    float fade = clamp(anchors[slot].fade + (stays ? fadeIn : -fadeOut), 0.0, 1.0);
    anchors[slot].fade = fade;
    if (!stays && fade == 0.0) anchors[slot].state = 0u;
  }
  ivec2 at = cellAt(anchors[slot].px);
  if (!stays || !isInGrid(at)) return;
  int index = indexOf(at);
  // The youngest anchor is removed first: viewers look at those that have been there for long.
  uint youth = 4095u - min(uint(anchors[slot].age * kAgeUnits), 4095u);
  uint candidate = youth << kSlotBits | slot;
  if ((state & kMover) != 0u) {
    atomicAdd(cells[index].onMovers, 1u);
    atomicMax(cells[index].nextMoverToRemove, candidate);
    return;
  }
  uint object = objectOf(anchors[slot].surface);
  bool isOnObject = isVirtual(object);
  if (isOnObject) {
    atomicAdd(cells[index].onObjects, 1u);
    atomicOr(cells[index].patches, patchBitAt(anchors[slot].px, object));
  } else {
    atomicAdd(cells[index].inImage, 1u);
  }
  atomicOr(cells[index].strata, 1u << (stratumAt(anchors[slot].px, at) + (isOnObject ? 16u : 0u)));
  atomicMax(cells[index].nextToRemove, candidate);
}
