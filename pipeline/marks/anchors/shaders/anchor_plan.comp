// Purpose: assigns a free slot to each spawn, both in order, so that every GPU assigns the same
//          slots; where none is free, one of a dormant anchor, then of a covered one. A single work group.
// Inputs:  anchors, slots of them; births of the cells, cellCount of them.
// Outputs: cells: the index of the cell's first spawn; plan: the number of free slots, then the
//          slots; occupied_slots.glsl's, for the next frame.
// Precision: integers.
#include "pipeline/marks/anchors/shaders/anchor.glsl"
#include "pipeline/marks/anchors/shaders/anchor_cells.glsl"
#include "pipeline/marks/anchors/shaders/occupied_slots.glsl"
#include "pipeline/marks/anchors/shaders/anchor_slots.glsl"
layout(local_size_x = 128) in;
layout(std430, binding = 0) readonly buffer Anchors { Anchor anchors[]; };
layout(std430, binding = 1) buffer Cells { Cell cells[]; };
uniform uint slots;
uniform uint cellCount;

shared uint freeBefore[128];
shared uint bornBefore[128];
shared uint coveredBefore[128];
shared uint dormantBefore[128];

uint birthsOf(uint cell) {
  uint births = cells[cell].births;
  return birthsInImage(births) + birthsOnObjects(births) + birthsOnPatches(births) +
         birthsInImage(cells[cell].moverBirths);
}

void main() {
  uint me = gl_LocalInvocationID.x;
  uint slotsEach = (slots + 127u) / 128u;
  uint cellsEach = (cellCount + 127u) / 128u;
  uint firstSlot = min(me * slotsEach, slots);
  uint endSlot = min(firstSlot + slotsEach, slots);
  uint firstCell = min(me * cellsEach, cellCount);
  uint endCell = min(firstCell + cellsEach, cellCount);
  uint free = 0u;
  uint covered = 0u;
  uint dormant = 0u;
  for (uint i = firstSlot; i < endSlot; ++i) {
    uint state = anchors[i].state;
    free += isAlive(state) || isDormant(state) ? 0u : 1u;
    covered += isCovered(state) ? 1u : 0u;
    dormant += isDormant(state) ? 1u : 0u;
  }
  uint born = 0u;
  for (uint i = firstCell; i < endCell; ++i) born += birthsOf(i);
  freeBefore[me] = free;
  bornBefore[me] = born;
  coveredBefore[me] = covered;
  dormantBefore[me] = dormant;
  barrier();
  for (uint reach = 1u; reach < 128u; reach *= 2u) {
    uint freeThere = me >= reach ? freeBefore[me - reach] : 0u;
    uint bornThere = me >= reach ? bornBefore[me - reach] : 0u;
    uint coveredThere = me >= reach ? coveredBefore[me - reach] : 0u;
    uint dormantThere = me >= reach ? dormantBefore[me - reach] : 0u;
    barrier();
    freeBefore[me] += freeThere;
    bornBefore[me] += bornThere;
    coveredBefore[me] += coveredThere;
    dormantBefore[me] += dormantThere;
    barrier();
  }
  uint unused = freeBefore[127] + dormantBefore[127];
  if (me == 127u) {
    freeCount = unused + coveredBefore[127];
    occupiedCount = slots - freeBefore[127] + min(bornBefore[127], freeBefore[127]);
    occupiedGroups[0] = (occupiedCount + kSlotGroup - 1u) / kSlotGroup;
  }
  uint next = freeBefore[me] - free;
  uint nextDormant = freeBefore[127] + dormantBefore[me] - dormant;
  uint nextCovered = unused + coveredBefore[me] - covered;
  for (uint i = firstSlot; i < endSlot; ++i) {
    uint state = anchors[i].state;
    bool isFree = !isAlive(state) && !isDormant(state);
    // Before it are as many free slots as `next`, of which births take the first.
    uint births = bornBefore[127];
    if (!isFree || next < births) occupiedSlots[i - next + min(births, next)] = i;
    if (isDormant(state)) {
      freeSlots[nextDormant++] = i;
    } else if (isFree) {
      freeSlots[next++] = i;
    } else if (isCovered(state)) {
      freeSlots[nextCovered++] = i;
    }
  }
  uint number = bornBefore[me] - born;
  for (uint i = firstCell; i < endCell; ++i) {
    cells[i].firstBirth = number;
    number += birthsOf(i);
  }
}
