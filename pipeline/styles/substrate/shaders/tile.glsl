// Purpose: the size of the substrate's tile (kTilePixels of substrate.cpp).
// Inputs, outputs: px.
// Precision: integers.
const int kTile = 512;
