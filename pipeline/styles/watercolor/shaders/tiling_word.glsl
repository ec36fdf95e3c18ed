// Purpose: what a pixel of the tiling says, packed in one R32UI word: its cell, whether it is an edge
//          pixel (thesis eq. 4), and how strong its edge is.
// Inputs, outputs: cells (column, row); strengths in [0, 1].
// Precision: highp; integers are exact.
// Layout:  bits 0..10 column, 11..21 row, 22 edge, 24..31 square root of the strength in 1/255.
const uint kCellBits = 0x3FFFFFu;
const uint kEdgeBit = 0x400000u;

uint packCell(ivec2 cell) { return uint(cell.x) | (uint(cell.y) << 11u); }
uint packTiling(uint cell, bool isEdge, float strength) {
  uint coded = uint(sqrt(min(strength, 1.0)) * 255.0 + 0.5);
  return cell | (isEdge ? kEdgeBit : 0u) | (coded << 24u);
}
ivec2 cellOf(uint word) { return ivec2(word & 0x7FFu, (word >> 11u) & 0x7FFu); }
bool isEdge(uint word) { return (word & kEdgeBit) != 0u; }
// The root is what the 8 bits hold: faint edges matter most.
float strengthOf(uint word) {
  float root = float(word >> 24u) * (1.0 / 255.0);
  return root * root;
}
