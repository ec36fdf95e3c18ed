// Purpose: a picture as RGBA bytes, opaque.
// Inputs:  those of pack.glsl.
// Outputs: RGBA8: bytes 4x .. 4x + 3 of a packed row. Precision: highp, as pack.glsl.
#include "pipeline/present/shaders/pack.glsl"

layout(location = 0) out vec4 packedBytes;

void main() {
  ivec2 texel = ivec2(gl_FragCoord.xy);
  packedBytes = vec4(rgbAt(texel), 1.0);
}
