// Purpose: packs and unpacks a pixel of borders.frag: its label (scene/surface_form.glsl),
//          another label within reach, and the share of the pixel that its own strokes may paint; if
//          open, they may paint it all, and the share is that of the other label's strokes.
// Inputs, outputs: packed, or in parts.
// Precision: integers.
uint borderOf(uint own, uint other, float share, bool isOpen) {
  return own | other << 12u | uint(share * 127.0 + 0.5) << 24u | (isOpen ? 1u << 31u : 0u);
}
uint ownOf(uint border) { return border & 4095u; }
uint otherOf(uint border) { return border >> 12u & 4095u; }
float shareOf(uint border) { return float(border >> 24u & 127u) / 127.0; }
bool isOpen(uint border) { return border >> 31u != 0u; }
