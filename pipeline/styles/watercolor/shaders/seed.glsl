// Purpose: a cell's seed (cell_tiling.h, CellSeed): where it is drawn to from its anchor.
// Inputs, outputs: px of the full picture.
// Precision: highp.
struct Seed {
  vec2 offset;     // from the anchor
  float restless;  // how long it has had reason to move, s
  uint state;
  uint parent;     // the slot whose cell it was born in, plus one
  uint spare0;
  uint spare1;
  uint spare2;
};

const uint kMoving = 1u;
const uint kBornSeed = 2u;  // in this frame
const uint kLiving = 4u;
