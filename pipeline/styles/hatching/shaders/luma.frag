// Purpose: the luma of the image that tones and contours are taken from, in one byte, which is read
//          a dozen times.
// Inputs:  picture (marks::FilteredFrame).
// Outputs: R8: sRGB-coded luma.
// Precision: mediump suffices.
#include "pipeline/gpu/images/shaders/luma.glsl"
uniform sampler2D picture;
layout(location = 0) out float luma;

void main() { luma = lumaOf(texelFetch(picture, ivec2(gl_FragCoord.xy), 0).rgb); }
