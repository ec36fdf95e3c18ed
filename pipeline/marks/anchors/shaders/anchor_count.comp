// Purpose: fades anchors in and out, and counts the staying ones in each cell. One on a virtual
//          surface that has faded out becomes dormant.
// Inputs:  anchor_cells.glsl's; ids and forms (ArFrame) and their pixelsOfFull if hasObjects;
//          fadeIn, fadeOut, moverFadeOut: the part of a fade that this frame completes.
// Outputs: anchors; cells, whose counts were 0 (anchor_spawn.comp). One invocation per slot
//          of occupied_slots.glsl's.
// Precision: highp; counts are integers, so that order does not matter.
#include "pipeline/marks/anchors/shaders/anchor.glsl"
#include "pipeline/marks/anchors/shaders/anchor_cells.glsl"
#include "pipeline/marks/anchors/shaders/occupied_slots.glsl"
#include "pipeline/scene/render/shaders/object_id.glsl"
layout(local_size_x = 64) in;
layout(std430, binding = 0) buffer Anchors { Anchor anchors[]; };
layout(std430, binding = 1) buffer Cells { Cell cells[]; };
uniform float fadeIn;
uniform float fadeOut;
uniform float moverFadeOut;
#include "pipeline/marks/anchors/shaders/anchor_patch.glsl"

void main() {
  if (gl_GlobalInvocationID.x >= occupiedCount) return;
  uint slot = occupiedSlots[gl_GlobalInvocationID.x];
  uint state = anchors[slot].state;
  if (!isAlive(state)) return;
  bool isBehind = isCovered(state);
  bool stays = isBehind || isStaying(state);
  if (!isBehind) {
    float out_ = (state & kMover) != 0u ? moverFadeOut : fadeOut;
    float fade = clamp(anchors[slot].fade + (stays ? fadeIn : -out_), 0.0, 1.0);
    anchors[slot].fade = fade;
    if (!stays && fade == 0.0) anchors[slot].state = stateAfter(state, isVirtual(objectOf(anchors[slot].surface)));
  }
  ivec2 at = cellAt(anchors[slot].px);
  if (!stays || !isInGrid(at)) return;
  int index = indexOf(at);
  if ((state & kMover) != 0u) {
    if (isBehind) return;  // another mover is seen there
    atomicAdd(cells[index].onMovers, 1u);
    return;
  }
  uint object = objectOf(anchors[slot].surface);
  bool isOnObject = isVirtual(object);
  if (isOnObject) {
    atomicAdd(cells[index].onObjects, 1u);
    uint own = patchBitAt(anchors[slot].px, anchors[slot].surface);
    uint before = atomicOr(cells[index].patches, own);
    if ((before & own) != 0u) atomicOr(cells[index].crowdedPatches, own);
  } else if (isBehind && showsModel(anchors[slot].px)) {
    atomicAdd(cells[index].underModels, 1u);
    return;
  } else {
    atomicAdd(cells[index].inImage, 1u);
  }
  atomicOr(cells[index].strata, 1u << (stratumAt(anchors[slot].px, at) + (isOnObject ? 16u : 0u)));
}
