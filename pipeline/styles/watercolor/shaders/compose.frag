// Purpose: the picture where nothing is to be kept crisp.
// Inputs:  composition.glsl's.
// Outputs: RGBA8, sRGB-coded, opaque.
// Precision: highp, as composition.glsl says.
#include "pipeline/styles/watercolor/shaders/composition.glsl"
layout(location = 0) out vec4 picture;

void main() { picture = vec4(paintedAt(ivec2(gl_FragCoord.xy)), 1.0); }
