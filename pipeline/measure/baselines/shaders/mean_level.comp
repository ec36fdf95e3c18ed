// Purpose: a level of the pyramid that thesis §6.1.2 proposes, the mean of 2x2 tensors of the level
//          below, to time six ways of dividing the work (work_division.glsl; TEXTURE).
// Inputs:  the level below: tensors, row by row, `belowWidth` in a row, or RGBA32F; size: of this
//          level.
// Outputs: Level: tensors, row by row.
// Precision: highp.
#include "pipeline/measure/baselines/shaders/work_division.glsl"
#ifdef TEXTURE
uniform highp sampler2D tensors;
#else
layout(std430, binding = 1) readonly buffer Below { vec2 below[]; };
uniform int belowWidth;
#endif
layout(std430, binding = 0) writeonly buffer Level { vec2 level[]; };

vec2 tensorAt(int x, int y) {
#ifdef TEXTURE
  return texelFetch(tensors, ivec2(x, y), 0).xy;
#else
  return below[y * belowWidth + x];
#endif
}

void forEach(int x, int y) {
  level[y * size.x + x] = 0.25 * (tensorAt(2 * x, 2 * y) + tensorAt(2 * x + 1, 2 * y) +
                                  tensorAt(2 * x, 2 * y + 1) + tensorAt(2 * x + 1, 2 * y + 1));
}
