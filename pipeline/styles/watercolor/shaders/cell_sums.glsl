// Purpose: the sums over a cell's pixels, which tile.comp adds up and cells.comp reads.
// Inputs, outputs: none.
// Precision: integers.
// Layout:  kSumWords words per cell: linear R, G, B in 1/kLinearUnits, pixels, x, y and count of its
//          edge pixels, x and y of all.
const int kSumWords = 9;
const float kLinearUnits = 16384.0;
