// Purpose: the cells of other content, counted in turns: this frame's, the next one's, which is
//          cleared, and the previous one's.
// Inputs:  turn: the frame's number modulo 3; stepSeconds.
// Outputs: otherCells.
// Precision: integers.
layout(std430, binding = 0) buffer Tally { uint otherCells[3]; };
uniform uint turn;
uniform float stepSeconds;
