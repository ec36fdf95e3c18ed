// Purpose: what a cell is painted with, packed in one RG32UI texel: its sRGB-coded colour, 8 bits a
//          channel, and its seed's shift from home in 1/128 px (up to 256 px).
// Inputs, outputs: sRGB-coded colours in [0, 1]; shifts in px.
// Precision: highp; integers are exact.
uvec2 packPaint(vec3 srgb, vec2 shiftPixels) {
  return uvec2(packUnorm4x8(vec4(srgb, 1.0)), packSnorm2x16(shiftPixels / 256.0));
}
vec3 colourOf(uvec2 paint) { return unpackUnorm4x8(paint.x).rgb; }
vec2 shiftOf(uvec2 paint) { return unpackSnorm2x16(paint.y) * 256.0; }

// More or less of the same pigment (Bousseau et al., 2006, "Interactive watercolor rendering"):
// 0 leaves the colour, 1 squares it.
vec3 withPigment(vec3 colour, float more) { return colour * (1.0 - (1.0 - colour) * more); }
