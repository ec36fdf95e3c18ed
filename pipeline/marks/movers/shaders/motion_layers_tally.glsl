// Purpose: what is counted over the frame, in turns: this frame's, and the next one's, which is
//          cleared meanwhile.
// Inputs:  turn: 0 or 1, the other one in the next frame; stepSeconds.
// Outputs: otherCells: cells of other content; changedBlocks: blocks with edges that have changed;
//          keptBlocks: those of them whose edges are where they were.
// Precision: integers.
layout(std430, binding = 0) buffer Tally {
  uint otherCells[2];
  uint changedBlocks[2];
  uint keptBlocks[2];
};
uniform uint turn;
uniform float stepSeconds;
