// Purpose: a picture as YUYV pairs.
// Inputs:  those of pack.glsl.
// Outputs: RGBA8: bytes 4x .. 4x + 3 of a packed row. Precision: highp, as pack.glsl.
#include "pipeline/present/shaders/pack.glsl"

layout(location = 0) out vec4 packedBytes;

void main() {
  ivec2 texel = ivec2(gl_FragCoord.xy);
  int x = 2 * texel.x;
  vec2 chroma = chromaAt(texel.x, float(texel.y) + 0.5);
  packedBytes = vec4(lumaAt(ivec2(x, texel.y)), chroma.x, lumaAt(ivec2(x + 1, texel.y)), chroma.y);
}
