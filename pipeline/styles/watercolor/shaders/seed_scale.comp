// Purpose: takes every seed along when the picture gets another size: another level of quality.
// Inputs:  grid (n, m), cellPixels of the new size, seed, newPixels: new px for an old one.
// Outputs: seeds.
// Precision: seeds end on the lattice of home.glsl, within 1/128 px of their place.
#include "pipeline/styles/watercolor/shaders/home.glsl"
layout(local_size_x = 8, local_size_y = 8) in;
layout(std430, binding = 0) buffer Seeds { vec2 seeds[]; };
uniform ivec2 grid;
uniform vec2 cellPixels;
uniform uint seed;
uniform vec2 newPixels;

void main() {
  ivec2 cell = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(cell, grid))) return;
  int index = cell.y * grid.x + cell.x;
  seeds[index] = clampedSeed(seeds[index] * newPixels, cell, homeOf(cell, cellPixels, seed), grid,
                             cellPixels);
}
