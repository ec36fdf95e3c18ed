// Purpose: puts every seed home and empties the sums: the first frame and every reset.
// Inputs:  grid (n, m), cellPixels, seed.
// Outputs: seeds, sums, moments. Precision: exact.
#include "pipeline/styles/watercolor/shaders/home.glsl"
layout(local_size_x = 8, local_size_y = 8) in;
layout(std430, binding = 0) writeonly buffer Seeds { vec2 seeds[]; };
layout(std430, binding = 1) writeonly buffer Sums { uint sums[]; };
layout(std430, binding = 2) writeonly buffer Moments { uint moments[]; };
uniform ivec2 grid;
uniform vec2 cellPixels;
uniform uint seed;

void main() {
  ivec2 cell = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(cell, grid))) return;
  int index = cell.y * grid.x + cell.x;
  seeds[index] = homeOf(cell, cellPixels, seed);
  for (int i = 0; i < 8; ++i) {
    sums[index * 8 + i] = 0u;
    moments[index * 8 + i] = 0u;
  }
}
