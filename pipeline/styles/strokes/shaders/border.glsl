// Purpose: packs and unpacks a pixel of borders.frag: its label (scene/surface_form.glsl),
//          another label within a pixel, and the share of the pixel that is its own.
// Inputs, outputs: packed, or in parts.
// Precision: integers.
uint borderOf(uint own, uint other, float share) {
  return own | other << 12u | uint(share * 255.0 + 0.5) << 24u;
}
uint ownOf(uint border) { return border & 4095u; }
uint otherOf(uint border) { return border >> 12u & 4095u; }
float shareOf(uint border) { return float(border >> 24u) / 255.0; }
