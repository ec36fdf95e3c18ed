// Purpose: the initial tensors of an image (thesis §4.2, eq. 5-9; §6.1.2), to time six ways of
//          dividing the work: work_division.glsl's three, read from a buffer or from a texture
//          (TEXTURE).
// Inputs:  luma in [0, 1], row by row, or R32F; size.
// Outputs: Tensors: P (cos 2θ, sin 2θ) a pixel, row by row.
// Precision: highp.
#include "pipeline/measure/baselines/shaders/work_division.glsl"
#ifdef TEXTURE
uniform highp sampler2D luma;
#else
layout(std430, binding = 1) readonly buffer Luma { float lumas[]; };
#endif
layout(std430, binding = 0) writeonly buffer Tensors { vec2 made[]; };

float lumaAt(int x, int y) {
  ivec2 at = clamp(ivec2(x, y), ivec2(0), size - 1);
#ifdef TEXTURE
  return texelFetch(luma, at, 0).r;
#else
  return lumas[at.y * size.x + at.x];
#endif
}

void forEach(int x, int y) {
  float corners = lumaAt(x + 1, y + 1) - lumaAt(x - 1, y - 1);
  float others = lumaAt(x + 1, y - 1) - lumaAt(x - 1, y + 1);
  float gx = 2.0 * (lumaAt(x + 1, y) - lumaAt(x - 1, y)) + corners + others;
  float gy = 2.0 * (lumaAt(x, y + 1) - lumaAt(x, y - 1)) + corners - others;
  // The doubled angle without trigonometry, times P.
  float p = sqrt(gx * gx + gy * gy);
  made[y * size.x + x] = vec2(gx * gx - gy * gy, 2.0 * gx * gy) / max(p, 1e-6);
}
