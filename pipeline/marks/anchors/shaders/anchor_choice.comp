// Purpose: chooses, in each cell and by rank, the anchors that are the next to be removed and the
//          dormant one that is the next to wake.
// Inputs:  anchors; cells with the counts of anchor_count.comp; anchor_patch.glsl's.
// Outputs: cells: keys, and the number of dormant anchors. One invocation per slot of
//          occupied_slots.glsl's.
// Precision: integers, so that order does not matter; highp for places.
#include "pipeline/marks/anchors/shaders/anchor.glsl"
#include "pipeline/marks/anchors/shaders/anchor_cells.glsl"
#include "pipeline/marks/anchors/shaders/occupied_slots.glsl"
#include "pipeline/scene/render/shaders/object_id.glsl"
layout(local_size_x = 64) in;
layout(std430, binding = 0) readonly buffer Anchors { Anchor anchors[]; };
layout(std430, binding = 1) buffer Cells { Cell cells[]; };
#include "pipeline/marks/anchors/shaders/anchor_patch.glsl"

void main() {
  if (gl_GlobalInvocationID.x >= occupiedCount) return;
  uint slot = occupiedSlots[gl_GlobalInvocationID.x];
  uint state = anchors[slot].state;
  bool sleeps = isDormant(state) && (state & kHidden) == 0u;
  if (!sleeps && !isCovered(state) && !isStaying(state)) return;
  vec2 px = anchors[slot].px;
  ivec2 at = cellAt(px);
  if (!isInGrid(at)) return;
  int index = indexOf(at);
  uint rank = rankOf(anchors[slot].ageAndRank);
  uint object = objectOf(anchors[slot].surface);
  if (sleeps) {
    bool isFirst = (patchBitAt(px, anchors[slot].surface) & ~cells[index].patches) != 0u;
    atomicAdd(cells[index].dormant, 1u + (isFirst ? 1u << 16u : 0u));
    atomicMax(cells[index].nextToWake, wakingKey(slot, rank, isFirst));
  } else if ((state & kMover) != 0u) {
    atomicMax(cells[index].nextOnMovers, removalKey(slot, rank, false));
  } else if (isVirtual(object)) {
    bool isOnly = (patchBitAt(px, anchors[slot].surface) & ~cells[index].crowdedPatches) != 0u;
    atomicMax(cells[index].nextOnObjects, removalKey(slot, rank, isOnly));
  } else if (isCovered(state) && showsModel(px)) {
    atomicMax(cells[index].nextUnderModels, removalKey(slot, rank, false));
  } else {
    atomicMax(cells[index].nextInImage, removalKey(slot, rank, false));
  }
}
