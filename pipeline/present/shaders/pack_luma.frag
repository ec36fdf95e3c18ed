// Purpose: a picture as luma bytes: grey, and the first plane of I420 and NV12.
// Inputs:  those of pack.glsl.
// Outputs: RGBA8: bytes 4x .. 4x + 3 of a packed row. Precision: highp, as pack.glsl.
#include "pipeline/present/shaders/pack.glsl"

layout(location = 0) out vec4 packedBytes;

void main() {
  ivec2 texel = ivec2(gl_FragCoord.xy);
  ivec2 p = ivec2(4 * texel.x, texel.y);
  packedBytes = vec4(lumaAt(p), lumaAt(p + ivec2(1, 0)), lumaAt(p + ivec2(2, 0)),
                     lumaAt(p + ivec2(3, 0)));
}
