// Purpose: a cell's seed (cell_tiling.h, CellSeed): its displacement from its anchor.
// Inputs, outputs: px of the full image.
// Precision: highp.
struct Seed {
  vec2 offset;     // from the anchor
  float restless;  // how long its target has been far away, s
  uint state;
  uint parent;  // the slot of the cell in which it was spawned, plus one
  uint spare0;
  uint spare1;
  uint spare2;
};

const uint kMoving = 1u;
const uint kBornSeed = 2u;  // spawned in this frame
const uint kLiving = 4u;
const uint kHeldSeed = 8u;  // stays on its anchor: a mover is before its cell, or beside it
