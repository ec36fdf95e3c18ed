// Purpose: the slots that passes over anchors are dispatched for: each that is alive or dormant, and
//          the free ones that the frame's births were given, some of which may have found no place
//          (anchor_plan.comp lists them for the next frame).
// Inputs, outputs: OccupiedSlots: a command for glDispatchComputeIndirect, of which groups along y
//          and z are 1; how many slots there are, and the slots in rising order. kSlotGroup is the
//          local size of the passes.
// Precision: integers.
const uint kSlotGroup = 64u;
layout(std430, binding = 3) buffer OccupiedSlots {
  uint occupiedGroups[3];
  uint occupiedCount;
  uint occupiedSlots[];
};
