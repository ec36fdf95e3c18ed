// Purpose: the slots that hold an anchor, alive or dormant, after a frame's births
//          (anchor_plan.comp): those that the next frame's passes are dispatched for.
// Inputs, outputs: Kept: a command for glDispatchComputeIndirect, of groups of kKeptGroup
//          invocations; how many slots there are, and the slots, in order.
// Precision: integers.
const uint kKeptGroup = 64u;
layout(std430, binding = 3) buffer Kept {
  uint keptGroups[3];
  uint keptCount;
  uint keptSlots[];
};
