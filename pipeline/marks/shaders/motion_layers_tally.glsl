// Purpose: the cells of other content, counted in turns: this frame's, and the next one's, which is
//          cleared meanwhile.
// Inputs:  turn: 0 or 1, the other one in the next frame; stepSeconds.
// Outputs: otherCells.
// Precision: integers.
layout(std430, binding = 0) buffer Tally { uint otherCells[2]; };
uniform uint turn;
uniform float stepSeconds;
