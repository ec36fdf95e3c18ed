// Purpose: packs and unpacks a pixel of borders.frag: its virtual object (0 for real content),
//          another object within a pixel, and the share of the pixel that is its own.
// Inputs, outputs: packed, or in parts.
// Precision: integers.
#include "pipeline/marks/shaders/stroke_instance.glsl"
uint borderOf(uint own, uint other, float share) {
  return own | other << 9u | uint(share * 255.0 + 0.5) << 18u;
}
uint ownOf(uint border) { return border & 511u; }
uint otherOf(uint border) { return border >> 9u & 511u; }
float shareOf(uint border) { return float(border >> 18u) / 255.0; }
