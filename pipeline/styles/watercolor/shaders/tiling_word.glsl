// Purpose: a pixel of the tiling, packed into one R32UI word: its cell, whether it is an edge pixel
//          (thesis eq. 4), and the strength of its edge.
// Inputs, outputs: slots of the cells' anchors (marks/anchors/anchor_set.h); strengths in [0, 1].
// Precision: highp; integers are exact.
// Layout:  bits 0..21 slot, 22 edge, 24..31 square root of the strength in 1/255.
const uint kSlotBits = 0x3FFFFFu;
const uint kEdgeBit = 0x400000u;

// The upper 8 bits.
uint codeOf(float strength) { return uint(sqrt(min(strength, 1.0)) * 255.0 + 0.5); }
uint packTiling(uint slot, bool isEdge, uint code) {
  return slot | (isEdge ? kEdgeBit : 0u) | (code << 24u);
}
uint slotOf(uint word) { return word & kSlotBits; }
bool isEdge(uint word) { return (word & kEdgeBit) != 0u; }
// The 8 bits hold the square root: faint edges matter most.
float strengthOf(uint word) {
  float root = float(word >> 24u) * (1.0 / 255.0);
  return root * root;
}

// The texel of a slot, in textures with one texel per slot.
ivec2 texelOf(uint slot) { return ivec2(slot & 255u, slot >> 8u); }
