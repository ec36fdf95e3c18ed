// Purpose: packs and unpacks a pixel of borders.glsl: its label (marks/strokes/shaders/stroke_label.glsl), another
//          label within reach, and the share of the pixel that its own strokes may paint; if open,
//          they may paint it all, and the share is that of the other label's strokes.
// Inputs, outputs: packed, or in parts. From the lowest bit: two labels of 13 bits, 5 bits of the
//          share, a bit: open.
// Precision: integers.
#include "pipeline/marks/strokes/shaders/stroke_label.glsl"
uint borderOf(uint own, uint other, float share, bool isOpen) {
  return own | other << 13u | uint(share * 31.0 + 0.5) << 26u | (isOpen ? 1u << 31u : 0u);
}
uint ownOf(uint border) { return border & kLabelMask; }
uint otherOf(uint border) { return border >> 13u & kLabelMask; }
float shareOf(uint border) { return float(border >> 26u & 31u) / 31.0; }
bool isOpen(uint border) { return border >> 31u != 0u; }

// Whether a mover ends there.
bool isMoverBorder(uint border) {
  uint own = ownOf(border);
  uint other = otherOf(border);
  return own != other && (isMover(own) || isMover(other));
}
