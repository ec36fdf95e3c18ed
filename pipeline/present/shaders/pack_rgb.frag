// Purpose: a picture as RGB bytes.
// Inputs:  those of pack.glsl.
// Outputs: RGBA8: bytes 4x .. 4x + 3 of a packed row. Precision: highp, as pack.glsl.
#include "pipeline/present/shaders/pack.glsl"

layout(location = 0) out vec4 packedBytes;

void main() {
  ivec2 texel = ivec2(gl_FragCoord.xy);
  int column = 4 * texel.x;
  vec3 first = rgbAt(ivec2(column / 3, texel.y));
  vec3 second = rgbAt(ivec2(column / 3 + 1, texel.y));
  int part = column % 3;
  packedBytes = part == 0   ? vec4(first, second.r)
                : part == 1 ? vec4(first.gb, second.rg)
                            : vec4(first.b, second);
}
