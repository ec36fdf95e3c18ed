// Purpose: assigns a free slot to each spawn, both in order, so that every GPU assigns the same
//          slots. A single work group.
// Inputs:  anchors, slots of them; births of the cells, cellCount of them.
// Outputs: cells: the index of the cell's first spawn; plan: the number of free slots, then the
//          slots.
// Precision: integers.
#include "pipeline/marks/shaders/anchor.glsl"
#include "pipeline/marks/shaders/anchor_cells.glsl"
#include "pipeline/marks/shaders/anchor_slots.glsl"
layout(local_size_x = 128) in;
layout(std430, binding = 0) readonly buffer Anchors { Anchor anchors[]; };
layout(std430, binding = 1) buffer Cells { Cell cells[]; };
uniform uint slots;
uniform uint cellCount;

shared uint freeBefore[128];
shared uint bornBefore[128];

uint birthsOf(uint cell) { return (cells[cell].births & 0xFFFFu) + (cells[cell].births >> 16u); }

void main() {
  uint me = gl_LocalInvocationID.x;
  uint slotsEach = (slots + 127u) / 128u;
  uint cellsEach = (cellCount + 127u) / 128u;
  uint firstSlot = min(me * slotsEach, slots);
  uint endSlot = min(firstSlot + slotsEach, slots);
  uint firstCell = min(me * cellsEach, cellCount);
  uint endCell = min(firstCell + cellsEach, cellCount);
  uint free = 0u;
  for (uint i = firstSlot; i < endSlot; ++i) free += isAlive(anchors[i].state) ? 0u : 1u;
  uint born = 0u;
  for (uint i = firstCell; i < endCell; ++i) born += birthsOf(i);
  freeBefore[me] = free;
  bornBefore[me] = born;
  barrier();
  for (uint reach = 1u; reach < 128u; reach *= 2u) {
    uint freeThere = me >= reach ? freeBefore[me - reach] : 0u;
    uint bornThere = me >= reach ? bornBefore[me - reach] : 0u;
    barrier();
    freeBefore[me] += freeThere;
    bornBefore[me] += bornThere;
    barrier();
  }
  if (me == 127u) freeCount = freeBefore[127];
  uint next = freeBefore[me] - free;
  for (uint i = firstSlot; i < endSlot; ++i) {
    if (isAlive(anchors[i].state)) continue;
    freeSlots[next] = i;
    ++next;
  }
  uint number = bornBefore[me] - born;
  for (uint i = firstCell; i < endCell; ++i) {
    cells[i].firstBirth = number;
    number += birthsOf(i);
  }
}
