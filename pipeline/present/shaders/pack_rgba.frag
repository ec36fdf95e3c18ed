// Purpose: a picture as RGBA bytes, opaque, turned by right angles.
// Inputs:  those of pack.glsl (the picture's size is the one before it is turned), quarterTurns:
//          clockwise, 0 to 3; origin of the picture in the target.
// Outputs: RGBA8: bytes 4x .. 4x + 3 of a packed row. Precision: highp, as pack.glsl.
#include "pipeline/present/shaders/pack.glsl"
uniform int quarterTurns;
uniform ivec2 origin;

layout(location = 0) out vec4 packedBytes;

void main() {
  ivec2 p = ivec2(gl_FragCoord.xy) - origin;
  ivec2 last = textureSize(picture, 0) - 1;
  if (quarterTurns == 1) p = ivec2(p.y, last.y - p.x);
  if (quarterTurns == 2) p = last - p;
  if (quarterTurns == 3) p = ivec2(last.x - p.y, p.x);
  packedBytes = vec4(rgbAt(p), 1.0);
}
