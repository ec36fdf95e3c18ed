// Purpose: blocks of cells that movers have, and the parts that they form: blocks that touch.
// Inputs, outputs: as commented. Precision: integers.
const uint kNoPart = 0xFFFFFFFFu;

struct MoverBlock {
  uint parent;     // a block of the same part, or itself; kNoPart: no mover is in it
  uint counts[4];  // sampled cells: of no number yet, and of each mover; of the part in its first block
  int motion[6];   // of the part: sum over its blocks of each mover's motion, 1/256 px
  uint low;        // of the part: the box around it, in blocks
  uint high;
  uint left;
  uint right;
};
