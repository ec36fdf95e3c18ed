// Purpose: blocks of cells of marks::MotionLayers.
// Inputs:  none.
// Outputs: the side of a block in cells.
// Precision: integers.
const int kLayerBlock = 8;
