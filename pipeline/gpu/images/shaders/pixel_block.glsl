// Purpose: the block of 4x4 pixels that one invocation of some passes does (gpu/images/pixel_block.h).
// Inputs:  the number of a pixel in the block, row by row.
// Outputs: its place in the block.
// Precision: integers.
const int kBlockSide = 4;
const int kBlockPixels = kBlockSide * kBlockSide;

ivec2 inBlock(int pixel) { return ivec2(pixel & 3, pixel >> 2); }
