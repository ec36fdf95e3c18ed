// Purpose: the free slots that a frame's spawns take, in order (anchor_plan.comp, anchor_spawn.comp).
// Inputs, outputs: slots of anchors.
// Precision: integers.
layout(std430, binding = 2) buffer Plan {
  uint freeCount;
  uint freeSlots[];
};
