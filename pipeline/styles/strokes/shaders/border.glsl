// Purpose: packs and unpacks a pixel of borders.frag: its label (marks/stroke_label.glsl), another
//          label within a pixel, and the share of the pixel that is its own.
// Inputs, outputs: packed, or in parts. From the lowest bit: two labels of 13 bits, 6 bits of the
//          share.
// Precision: integers.
#include "pipeline/marks/shaders/stroke_label.glsl"
uint borderOf(uint own, uint other, float share) {
  return own | other << 13u | uint(share * 63.0 + 0.5) << 26u;
}
uint ownOf(uint border) { return border & kLabelMask; }
uint otherOf(uint border) { return border >> 13u & kLabelMask; }
float shareOf(uint border) { return float(border >> 26u) / 63.0; }
