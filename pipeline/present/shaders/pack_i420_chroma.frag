// Purpose: a chroma plane of I420.
// Inputs:  those of pack.glsl, plane (1: Cb, 2: Cr), origin of the plane in the
//          target.
// Outputs: RGBA8: bytes 4x .. 4x + 3 of a packed row. Precision: highp, as pack.glsl.
#include "pipeline/present/shaders/pack.glsl"
uniform ivec2 origin;
uniform int plane;

layout(location = 0) out vec4 packedBytes;

void main() {
  ivec2 texel = ivec2(gl_FragCoord.xy) - origin;
  int row = texel.y;
  int pair = 4 * texel.x;
  vec2 a = chroma420(pair, row), b = chroma420(pair + 1, row);
  vec2 c = chroma420(pair + 2, row), d = chroma420(pair + 3, row);
  packedBytes = plane == 1 ? vec4(a.x, b.x, c.x, d.x) : vec4(a.y, b.y, c.y, d.y);
}
