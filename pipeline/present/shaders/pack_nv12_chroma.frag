// Purpose: the chroma plane of NV12.
// Inputs:  those of pack.glsl, origin of the plane in the target.
// Outputs: RGBA8: bytes 4x .. 4x + 3 of a packed row. Precision: highp, as pack.glsl.
#include "pipeline/present/shaders/pack.glsl"
uniform ivec2 origin;

layout(location = 0) out vec4 packedBytes;

void main() {
  ivec2 texel = ivec2(gl_FragCoord.xy) - origin;
  int row = texel.y;
  packedBytes = vec4(chroma420(2 * texel.x, row), chroma420(2 * texel.x + 1, row));
}
