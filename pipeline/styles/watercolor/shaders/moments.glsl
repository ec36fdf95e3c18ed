// Purpose: the moments of a cell's pixels, which split.comp sums and washes.comp reads.
// Inputs:  8-bit colours of the guide.
// Outputs: their luma L = 2 R + 5 G + B, whose mean is exactly that of the mean colour.
// Precision: integers.
// Layout:  kMomentWords words per cell: R, G, B, count, L R, L G, L B, L³ / 8192.
const int kMomentWords = 8;
const uvec3 kMomentLuma = uvec3(2u, 5u, 1u);

uint momentLuma(uvec3 rgb) {
  return kMomentLuma.r * rgb.r + kMomentLuma.g * rgb.g + kMomentLuma.b * rgb.b;
}
