// Purpose: the brightness of a colour as ITU-R BT.601 weighs it.
// Inputs:  sRGB-coded colours, differences of them, or their optical densities.
// Outputs: their luma, in the same range.
// Precision: mediump suffices for colours.
const vec3 kLuma = vec3(0.299, 0.587, 0.114);

float lumaOf(vec3 srgb) { return dot(srgb, kLuma); }
