// Purpose: the cells that movers cover, counted in turns: this frame's, the next one's, which is
//          cleared, and the previous one's, which is read.
// Inputs:  turn: the frame's number modulo 3; stepSeconds.
// Outputs: moverCells.
// Precision: integers.
layout(std430, binding = 0) buffer Tally { uint moverCells[3]; };
uniform uint turn;
uniform float stepSeconds;
