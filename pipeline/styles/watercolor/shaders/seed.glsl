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
const uint kAtEdge = 2u;  // follows edge pixels, not the middle of its cell
const uint kBornSeed = 4u;
const uint kLiving = 8u;
